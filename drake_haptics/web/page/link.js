// The way to the run: JSON over one websocket, tried again when it breaks.

const RETRY_MS = 1000;
let socket = null;
// Requests that are answered are numbered, so that a state from before one does not undo it.
let asked = 0, lost = 0;

/** Connects, and goes on until told that the run is over. */
export function connect(on) {
  let isOver = false;
  socket = new WebSocket("ws://" + location.host + "/");
  // From now on no more frames come than are shown.
  socket.onopen = () => say({do: "seen", number: 0});
  socket.onmessage = event => {
    const message = JSON.parse(event.data);
    if ("over" in message) isOver = true;
    if (message.frame?.number) say({do: "seen", number: message.frame.number});
    for (const [name, value] of Object.entries(message)) on[name]?.(value);
  };
  socket.onclose = () => {
    lost = asked;
    if (!isOver) on.lost();
    setTimeout(() => connect(on), RETRY_MS);
  };
}

export function say(message) {
  if (socket?.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message));
}

/** Says what a state answers; returns its number. */
export function ask(message) {
  asked += 1;
  say({...message, number: asked});
  return asked;
}

/** Whether a state is from before a request. One on a way that broke may never be answered. */
export const isBefore = (answered, number) => number > Math.max(answered, lost);
