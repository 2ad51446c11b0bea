// The way to the run: JSON over one websocket, tried again when it breaks.

const RETRY_MS = 1000;
let socket = null;

/** Connects, and goes on until told that the run is over. */
export function connect(on) {
  let isOver = false;
  socket = new WebSocket("ws://" + location.host + "/");
  socket.onmessage = event => {
    const message = JSON.parse(event.data);
    if ("over" in message) isOver = true;
    for (const [name, value] of Object.entries(message)) on[name]?.(value);
  };
  socket.onclose = () => {
    if (!isOver) on.lost();
    setTimeout(() => connect(on), RETRY_MS);
  };
}

export function say(message) {
  if (socket?.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message));
}
