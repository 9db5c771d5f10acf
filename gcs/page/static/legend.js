// What the shapes of the scene mean: small drawings in the palette's colours, with words.

const SVG = "http://www.w3.org/2000/svg";

function drawing(parts) {
  const box = document.createElementNS(SVG, "svg");
  box.setAttribute("viewBox", "0 0 34 16");
  box.setAttribute("aria-hidden", "true");
  for (const [kind, given] of parts) {
    const part = document.createElementNS(SVG, kind);
    for (const [name, value] of Object.entries({ fill: "none", ...given })) part.setAttribute(name, value);
    box.append(part);
  }
  return box;
}

const line = (stroke, dashes = "") => ["path", { d: "M1 8H33", stroke, "stroke-width": 2, "stroke-dasharray": dashes }];
const ring = (stroke, r, dashes = "") => ["circle", { cx: 17, cy: 8, r, stroke, "stroke-width": 1.6, "stroke-dasharray": dashes }];
const sector = (fill) => [["path", { d: "M3 8L31 1V15Z", fill, "fill-opacity": 0.35, stroke: fill }]];

// Drawing and words of each shape.
export function entries(c) {
  const [evader, pursuer] = [c.vehicle(1, true), c.vehicle(2, false)];
  return [
    [[["path", { d: "M10 1L24 8L10 15Z", fill: evader }]], "evader, nose ahead; grey: out of the game; pursuers: other colours"],
    [[line(pursuer)], "way flown; the thin line down is the height"],
    [[line(pursuer, "3 3")], "aim of the rule in force"],
    [[line(evader, "1 3")], "of several evaders: who is after which"],
    [[["path", { d: "M2 13Q17 -3 32 13M26 11L32 13L30 7", stroke: pursuer, "stroke-width": 1.6 }]], "relation that the team knows, and how strong it is"],
    [[ring(c.target, 6), ["path", { d: "M11 8H23M17 2V14", stroke: c.target }]], "target of an evader"],
    [[ring(c.capture, 4), ring(c.safety, 7, "3 2")], "capture radius R; dashed: safety distance ρ"],
    [[ring(evader, 4), ring(evader, 7, "3 2")], "an evader after 1, 2, 4 s: 1σ; dashed: 2σ"],
    [[ring(c.apollonius, 7)], "Apollonius: both can be there at one time"],
    [sector(c.cone), "headings blocked for the selected vehicle"],
    [[["path", { d: "M5 12A13 13 0 0 1 29 12", stroke: c.free, "stroke-width": 4, "stroke-opacity": 0.6 }]], "ways out of an evader: its free headings"],
    [[["rect", { x: 3, y: 3, width: 28, height: 10, stroke: c.fence, "stroke-width": 1.6 }]], "fence: nobody leaves it"],
    [[["rect", { x: 8, y: 2, width: 18, height: 12, stroke: c.zone, fill: c.zone, "fill-opacity": 0.35, "stroke-width": 1.6 }]], "zone: everybody keeps out"],
  ];
}

export function drawLegend(list, colours) {
  list.replaceChildren(...entries(colours).flatMap(([parts, words]) => {
    const [term, meaning] = [document.createElement("dt"), document.createElement("dd")];
    term.append(drawing(parts));
    meaning.textContent = words;
    return [term, meaning];
  }));
}
