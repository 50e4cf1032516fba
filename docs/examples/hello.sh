#!/bin/sh
# A text, then a stop, by curl: `mmmd run --http 127.0.0.1:5880`, then `sh docs/examples/hello.sh`.
set -e
at=${1:-http://127.0.0.1:5880}
curl -sS -d 'wave with your right hand' "$at/v1/cmd"
sleep 2
curl -sS -d stop "$at/v1/ctl"
