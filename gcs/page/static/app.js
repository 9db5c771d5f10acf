// The live page: one WebSocket, the scene, tables, alerts and orders. Texts are set as text, never as markup.
import { colours } from "colours";
import { reader } from "frames";
import { drawLegend } from "legend";
import { GroundMap } from "map";
import { moved } from "moves";
import { Scene } from "scene";
import { VehicleTable } from "table";
import { Timeline } from "timeline";

const LOST_MS = 1500; // without a frame for so long the page is grey
const AGAIN_MS = 700; // between attempts to connect
const SAID_MS = 8000;
const $ = (id) => document.getElementById(id);
const dark = matchMedia("(prefers-color-scheme: dark)");
const page = { hello: null, board: null, field: null, selected: null, frames: 0, heard: performance.now(), delays: [] };
window.page = page; // for those who look from outside: tests and benchmarks

const scene = new Scene($("scene"), {
  pick: (id) => table.choose(id),
  pointer: (at) => {
    $("pointer").textContent = at ? `N ${at[0].toFixed(1)}  E ${at[1].toFixed(1)} m${degrees(at)}` : "";
  },
  drawn: (frame) => {
    page.frames += 1;
    page.delays.push(Date.now() - frame.ms);
    if (page.delays.length > 4096) page.delays.shift();
  },
});
page.scene = scene;
const table = new VehicleTable($("vehicles"), $("filter"), { choose: chosen });
const timeline = new Timeline($("time"), say);
let socket = null;
let read = null;

function degrees([north, east]) {
  const origin = page.field && page.field.origin;
  if (!origin) return "";
  const radius = 6371008.8;
  const latitude = origin[0] + (north / radius) * (180 / Math.PI);
  const longitude = origin[1] + (east / radius / Math.cos((origin[0] * Math.PI) / 180)) * (180 / Math.PI);
  return `  ${latitude.toFixed(5)}° ${longitude.toFixed(5)}°`;
}

function send(message) {
  if (socket && socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message));
  else told("not connected: nothing was sent");
}

function say(message) {
  send(message);
}

function told(text) {
  $("said").textContent = text;
  clearTimeout(told.timer);
  told.timer = setTimeout(() => { $("said").textContent = ""; }, SAID_MS);
}

function theme() {
  if (!page.hello) return;
  page.colours = colours(page.hello.palette, dark.matches);
  scene.setColours(page.colours);
  timeline.setColours(page.colours);
  drawLegend($("legend"), page.colours);
  if (page.map) page.map.setDark(dark.matches);
}
dark.addEventListener("change", theme);

const hear = {
  hello(message) {
    page.hello = message;
    read = reader(message.frame);
    $("title").textContent = message.title === "live" ? "Apollonius" : message.title;
    document.title = `Apollonius: ${message.title}`;
    $("abort").hidden = !message.steers;
    drawOrders();
    table.setColumns(message.columns, message.grades);
    if (message.map && !page.map) page.map = new GroundMap(scene, message.map);
    $("map").hidden = !message.map;
    $("credit").textContent = message.map ? message.map.credit : "";
    theme();
  },
  field(message) {
    page.field = message;
    scene.setField(message);
    if (page.map) page.map.setOrigin(message.origin);
  },
  marks: (message) => timeline.setMarks(message),
  trails(message) {
    scene.setTrails(message);
  },
  fans: (message) => scene.setFans(message),
  board(message) {
    page.board = message;
    drawBoard(message);
    scene.setBoard(message);
    if (message.timeline) {
      page.replay = { ...message.timeline, now_ms: message.now_ms };
      timeline.show(message.timeline);
    }
  },
  detail(message) {
    if (message.id !== page.selected) return;
    scene.setDetail(message);
    drawDetail(message);
  },
  said: (message) => told(message.text),
  answered(message) {
    $("question").close();
    told(message.text);
  },
  ask(message) {
    $("question-text").textContent = message.text;
    if (!$("question").open) $("question").showModal();
  },
  selected: (message) => table.choose(Number(message.text)),
  sort: (message) => table.sortBy(message.text),
  help: () => showHelp(),
  quit: () => told("close the tab to leave: vehicles fly on"),
};

function connect() {
  const scheme = location.protocol === "https:" ? "wss" : "ws";
  socket = new WebSocket(`${scheme}://${location.host}/live${location.search}`);
  socket.binaryType = "arraybuffer";
  socket.onmessage = (event) => {
    page.heard = performance.now();
    if (typeof event.data === "string") {
      const message = JSON.parse(event.data);
      if (hear[message.what]) hear[message.what](message);
    } else if (read) {
      scene.setFrame(read(event.data), page.hello.roles);
      if (page.replay) timeline.draw(page.replay.at_ms + page.scene.frame.ms - page.replay.now_ms);
    }
  };
  socket.onopen = () => { if (page.selected !== null) send({ do: "select", id: page.selected }); };
  socket.onclose = () => { socket = null; setTimeout(connect, AGAIN_MS); };
}

function watch() {
  const silent = performance.now() - page.heard;
  const lost = silent > LOST_MS;
  document.body.classList.toggle("lost", lost);
  $("lost").hidden = !lost;
  if (lost) {
    page.since = page.since || new Date(Date.now() - silent);
    $("lost").textContent = `Connection lost since ${page.since.toISOString().slice(11, 19)} UTC. What is shown is old. Trying again…`;
  } else page.since = null;
}
setInterval(watch, 200);

function drawBoard(board) {
  const { game } = board;
  $("game").textContent = game.scenario || (game.phase ? game.name : `game ${game.name}: no master heard`);
  $("phase").textContent = game.outcome ? game.outcome.words : game.phase.toUpperCase();
  $("clock").textContent = game.clock;
  $("odds").textContent = board.situation && !game.outcome ? board.situation.words : "";
  $("plan").textContent = game.plan ? game.plan.words : "";
  $("status").textContent = board.status;
  table.setRows(board.vehicles, page.colours);
  drawAlerts(board.alerts);
  drawCommands(board.commands);
  drawLog(board.log);
  drawKnown(board.knowledge);
  if (page.selected === null && board.vehicles.length) table.choose(board.vehicles[0].id);
}

// Give a list exactly these texts; only what has changed is touched.
function lines(list, items, make) {
  const key = JSON.stringify(items);
  if (list.dataset.key === key) return;
  list.dataset.key = key;
  list.replaceChildren(...items.map(make));
}

function element(tag, text, className = "") {
  const found = document.createElement(tag);
  found.textContent = text;
  if (className) found.className = className;
  return found;
}

function drawAlerts(alerts) {
  lines($("alert-list"), alerts, (alert) => {
    const item = element("li", "", alert.acknowledged ? "seen" : "");
    const word = alert.severity === "error" ? "ERROR " : alert.severity === "warning" ? "warning " : "";
    item.append(element("span", `${word}${alert.text} (since ${alert.since})`, alert.severity));
    if (page.hello.steers && !alert.acknowledged) {
      const button = element("button", "seen");
      button.addEventListener("click", () => send({ do: "acknowledge", name: alert.name }));
      item.append(button);
    } else item.append(element("span", alert.acknowledged ? "✓ seen" : ""));
    item.append(element("span", `→ ${alert.advice}`, "advice"));
    return item;
  });
  if (!alerts.length) $("alert-list").replaceChildren(element("li", "none"));
}

function drawCommands(commands) {
  $("commands").hidden = !commands.length;
  lines($("command-list"), [...commands].reverse(), (command) => {
    const done = command.legs.filter((leg) => leg.state === "confirmed");
    const took = Math.max(0, ...command.legs.map((leg) => leg.took || 0));
    const item = element("li", `${command.kind}: ${done.length} of ${command.legs.length} confirmed${command.confirmed ? ` in ${took.toFixed(1)} s` : ""}`);
    item.className = command.confirmed ? "grade-ok" : "warning";
    for (const leg of command.legs) {
      if (leg.state === "confirmed") continue;
      item.append(element("div", `${leg.id}: ${leg.state}${leg.reason ? ` (${leg.reason})` : ""}`));
    }
    return item;
  });
}

function drawLog(log) {
  lines($("log"), [...log].reverse(), (line) => element("li", line));
}

// The team's goals with why, and what holds in the game against the evader that the selected vehicle is about.
function drawKnown(knowledge) {
  $("knowledge").hidden = !knowledge.length;
  const chosen = scene.knownEvader();
  const lines = knowledge.flatMap((one) => [
    { evader: one.evader, goal: one.goal || "no goal" }, ...(one.evader === chosen ? one.lines : []),
  ]);
  const key = JSON.stringify(lines);
  if ($("known").dataset.key === key) return;
  $("known").dataset.key = key;
  $("known").replaceChildren(...lines.map((line) => {
    if (line.goal) return element("p", knowledge.length > 1 ? `evader ${line.evader}: ${line.goal}` : line.goal, "goal");
    const item = element("p", "", "relation");
    const bar = element("meter", "");
    bar.value = line.strength;
    item.append(bar, element("span", line.strength.toFixed(2), "strength"), element("span", line.words));
    return item;
  }));
}

function drawDetail(detail) {
  const sentence = detail.decision ? [element("p", detail.decision.sentence, "sentence")] : [];
  const styled = (style) => (style.includes("red") ? "error" : style.includes("yellow") ? "warning" : "");
  $("detail").replaceChildren(...sentence, ...detail.lines.map(([text, style]) => element("p", text, styled(style))));
}

function chosen(ids, first) {
  page.ids = ids;
  page.selected = first;
  scene.select(first);
  if (page.board) drawKnown(page.board.knowledge);
  if (scene.following !== null) scene.following = first;
  send({ do: "select", id: first });
  drawWhom();
}

// To whom orders go: always those that `order` takes, after a new connection too.
function drawWhom() {
  const whom = document.querySelector("#orders .whom");
  const ids = page.ids || [];
  const several = ids.length > 1 ? `${ids.length} vehicles: ` : "vehicle ";
  if (whom) whom.textContent = ids.length ? `to ${several}${ids.join(", ")}` : "to no vehicle";
}

function order(kind) {
  if (!page.ids || !page.ids.length) told("no vehicle is selected");
  else send({ do: "give", kind, ids: page.ids, named: page.ids.length === 1 });
}

function drawOrders() {
  const area = $("orders");
  area.hidden = !page.hello.steers;
  if (area.hidden) return;
  const keys = { hold: "h", resume: "r", return: "b", land: "l" };
  const buttons = page.hello.orders.filter((kind) => kind !== "abort").map((kind) => {
    const button = element("button", kind);
    if (keys[kind]) button.append(" ", element("kbd", keys[kind]));
    button.addEventListener("click", () => order(kind));
    return button;
  });
  const abort = element("button", "abort these", "danger");
  abort.addEventListener("click", () => order("abort"));
  const typed = document.createElement("input");
  typed.id = "line";
  typed.placeholder = "type an order: hold 2 3, start all";
  typed.setAttribute("aria-label", "type an order");
  typed.size = 28;
  typed.addEventListener("keydown", (event) => {
    if (event.key === "Enter" && typed.value.trim()) {
      send({ do: "line", text: typed.value });
      typed.value = "";
    }
    if (event.key === "Escape") typed.blur();
  });
  area.replaceChildren(element("h2", "Orders"), element("span", "", "whom"), ...buttons, abort, typed);
  drawWhom();
}

function showHelp() {
  const rows = [
    ["x", "ABORT ALL: everybody holds or returns"], ["h r b l", "hold, resume, return, land those selected; return and land ask"],
    ["y n", "answer"], [":", "type an order"], ["a", "the topmost alert was seen"], ["↑ ↓ j k", "select the vehicle above or below"],
    ["v f c", "plan or 3-D; fit; follow the selected vehicle"], ["t o i w m", "trails, shapes, aims, relations, map on and off"],
    ["shift+arrows", "turn the 3-D view, shift the plan"], ["page up, page down", "nearer, farther"],
    ["space", "replay: pause and play"], ["← → , .", "replay: 10 s, 0.1 s"], ["[ ]", "replay: the mark before, after"],
    ["+ −", "replay: faster, slower"], ["home end", "replay: to its begin, its end"],
    ["tab enter", "every button, column and vehicle; with shift or ctrl several vehicles"], ["?", "this help"],
    ...(page.hello ? page.hello.help : []),
  ];
  const list = document.createElement("table");
  for (const [key, text] of rows) {
    const row = document.createElement("tr");
    row.append(element("td", key), element("td", text));
    list.append(row);
  }
  const close = element("button", "close");
  close.addEventListener("click", () => $("help").close());
  $("help").replaceChildren(element("h2", "Keys and orders"), list, close);
  $("help").showModal();
}

function press(button) {
  const on = button.getAttribute("aria-pressed") !== "true";
  button.setAttribute("aria-pressed", on);
  return on;
}

function view(name) {
  for (const button of document.querySelectorAll("[data-view]")) button.setAttribute("aria-pressed", button.dataset.view === name);
  scene.setView(name);
}

function follow() {
  scene.following = press($("follow")) ? page.selected : null;
}

function showMap() {
  if (page.map) page.map.show(press($("map")));
}

function legend(on) {
  $("legend-on").setAttribute("aria-pressed", on);
  $("legend").hidden = !on;
}

for (const button of document.querySelectorAll("[data-view]")) button.addEventListener("click", () => view(button.dataset.view));
for (const button of document.querySelectorAll("[data-show]")) button.addEventListener("click", () => scene.show(button.dataset.show, press(button)));
$("fit").addEventListener("click", () => scene.fit());
$("follow").addEventListener("click", follow);
$("map").addEventListener("click", () => showMap());
$("legend-on").addEventListener("click", () => legend($("legend").hidden));
$("abort").addEventListener("click", () => send({ do: "abort" }));
$("yes").addEventListener("click", () => { $("question").close(); send({ do: "yes" }); });
$("no").addEventListener("click", () => { $("question").close(); send({ do: "no" }); });
$("question").addEventListener("cancel", () => send({ do: "no" }));

const toggles = { t: "trails", o: "shapes", i: "aims", w: "relations" };
document.addEventListener("keydown", (event) => {
  const { key } = event;
  const steers = page.hello && page.hello.steers;
  if (steers && key.toLowerCase() === "x" && event.ctrlKey) {
    event.preventDefault();
    send({ do: "abort" });
    return;
  }
  if (event.ctrlKey || event.metaKey || event.altKey || event.target.matches("input")) return;
  if (moved(scene, event)) {
    event.preventDefault();
    return;
  }
  const orders = { h: "hold", r: "resume", b: "return", l: "land" };
  if ($("question").open && (key === "y" || key === "n")) {
    $("question").close();
    send({ do: key === "y" ? "yes" : "no" });
  } else if (steers && key === "x") send({ do: "abort" });
  else if (steers && orders[key]) order(orders[key]);
  else if (steers && (key === ":" || key === "/")) $("line").focus();
  else if (steers && key === "a") send({ do: "line", text: "ack" });
  else if (key === "ArrowDown" || key === "j") table.move(1);
  else if (key === "ArrowUp" || key === "k") table.move(-1);
  else if (key === "v") view(scene.view === "plan" ? "space" : "plan");
  else if (key === "f") scene.fit();
  else if (key === "c") follow();
  else if (key === "m") showMap();
  else if (key === "g") legend($("legend").hidden);
  else if (toggles[key]) scene.show(toggles[key], press(document.querySelector(`[data-show=${toggles[key]}]`)));
  else if (key === "?") showHelp();
  else if (!timeline.key(key)) return;
  event.preventDefault();
});

// Two runs beside each other have one time: what is done in one is done in the other, since t₀.
if (window.parent !== window) {
  document.body.classList.add("half");
  const other = new BroadcastChannel("apollonius-time");
  timeline.moved = (what) => other.postMessage(what);
  other.onmessage = ({ data }) => {
    if (data.action) say({ do: "act", action: data.action });
    else say({ do: "seek", at_ms: Math.max(0, Math.round(data.since_ms + (timeline.marks ? timeline.marks.zero_ms : 0))) });
  };
}
connect();
