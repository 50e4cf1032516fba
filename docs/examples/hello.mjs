// A text with all its events, then a stop, by Node 18 or newer and nothing else:
// `mmmd run --http 127.0.0.1:5880`, then `node docs/examples/hello.mjs`.
const at = process.argv[2] ?? "http://127.0.0.1:5880";

const reply = await fetch(`${at}/v1/cmd?until=end`, { method: "POST", body: JSON.stringify({ type: "say", text: "wave with your right hand" }) });
for (const line of (await reply.text()).trim().split("\n")) {
  const event = JSON.parse(line);
  console.log(event.type, event.understood ?? event.found ?? "");
}
const stopped = await (await fetch(`${at}/v1/ctl`, { method: "POST", body: "stop" })).json();
console.log(stopped.type, stopped.verb);
