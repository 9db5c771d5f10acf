// The time of a replay: a slider with marks, pause, speed and steps. Hidden where the page is live.

const KEYS = { " ": "pause", ArrowRight: "on", ArrowLeft: "back", ".": "step", ",": "step_back", "+": "faster", "-": "slower", Home: "start", End: "end" };

export class Timeline {
  constructor(host, send) {
    this.host = host;
    this.send = send;
  }

  setColours(colours) {
    this.colours = colours;
  }

  key(key) {
    if (this.host.hidden || !KEYS[key]) return false;
    this.send({ do: "act", action: KEYS[key] });
    return true;
  }

  show() {
    this.host.hidden = false;
  }
}
