// Materials and colours, shared and kept. A WebGL program that no material uses any more is thrown away and compiled
// anew for the next one, which stops the drawing for tens of milliseconds: so what comes and goes takes its material here.
import { Color, DoubleSide, LineBasicMaterial, LineDashedMaterial, MeshBasicMaterial } from "three";

const made = new Map();

export function paint(key, make) {
  let found = made.get(key);
  if (!found) made.set(key, (found = make()));
  return found;
}

export const tint = (colour) => paint(`tint ${colour}`, () => new Color(colour));
export const plain = (colour) => paint(`plain ${colour}`, () => new LineBasicMaterial({ color: colour }));
export const veil = (colour, opacity) => paint(
  `veil ${colour} ${opacity}`,
  () => new MeshBasicMaterial({ color: colour, transparent: true, opacity, side: DoubleSide, depthWrite: false }),
);

export const dots = (colour) => paint(`dots ${colour}`, () => new LineDashedMaterial({ color: colour, dashSize: 0.3, gapSize: 1, transparent: true, opacity: 0.75 }));

export const faded = (colour, opacity) => paint(`faded ${colour} ${opacity}`, () => new LineBasicMaterial({ color: colour, transparent: true, opacity }));

// For lines whose `lineDistance` is counted in dashes.
export const dashes = (colour) => paint(`dashes ${colour}`, () => new LineDashedMaterial({ color: colour, dashSize: 1, gapSize: 0.65 }));
