// WebSockets to the server, one for each of the daemon's sockets; each connects again by itself, without end.
export const token = new URLSearchParams(location.hash.slice(1)).get("token") || sessionStorage.getItem("token") || "";
if (token) sessionStorage.setItem("token", token);

export const get = (path) => fetch(path, token ? { headers: { Authorization: `Bearer ${token}` } } : {});

get.post = async (path, body, signal) => (await fetch(path, { method: "POST", body, signal, headers: token ? { Authorization: `Bearer ${token}` } : {} })).json();

export class Line {
  constructor(kind, heard, changed = () => {}) {
    Object.assign(this, { kind, heard, changed, socket: null, wait: 250 });
    this.connect();
  }
  get open() { return this.socket?.readyState === WebSocket.OPEN; }
  connect() {
    const at = `${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/v1/${this.kind}`;
    const socket = this.socket = new WebSocket(at + (token ? `?token=${encodeURIComponent(token)}` : ""));
    socket.onopen = () => { this.wait = 250; this.changed(true); };
    socket.onmessage = (message) => this.heard(JSON.parse(message.data));
    socket.onclose = () => {
      this.changed(false);
      setTimeout(() => this.connect(), this.wait);
      this.wait = Math.min(2000, this.wait * 2);
    };
  }
  send(request) {
    if (!this.open) return false;
    this.socket.send(JSON.stringify({ ...stamp(), ...request }));
    return true;
  }
}

export const newId = () => Array.from(crypto.getRandomValues(new Uint8Array(12)), (b) => b.toString(16).padStart(2, "0")).join("");

// When a request was sent, on this page's own clock, so that the daemon knows a text given after a stop from one given before it.
const CLOCK = newId();
export const stamp = () => ({ t_mono: performance.now() / 1000, clock: CLOCK });
