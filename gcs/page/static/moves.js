// The camera by keys: turned and tilted in 3-D, shifted in plan, nearer and farther in both.
import { Vector3 } from "three";

const TURN = Math.PI / 24; // [rad] a key
const SHIFT = 0.08; // of the picture's height a key
const NEARER = 1.2; // times
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

function turn(scene, [right, down]) {
  const { target, maxPolarAngle } = scene.orbit;
  const { position } = scene.perspective;
  const from = new Vector3().subVectors(position, target);
  const far = from.length();
  const round = Math.atan2(from.x, from.z) + right * TURN;
  const tilt = Math.max(0.02, Math.min(maxPolarAngle, Math.acos(from.y / far) - down * TURN));
  from.set(Math.sin(tilt) * Math.sin(round), Math.cos(tilt), Math.sin(tilt) * Math.cos(round));
  position.copy(target).addScaledVector(from, far);
}

function shift(scene, [right, down]) {
  const step = ((scene.flat.top - scene.flat.bottom) / scene.flat.zoom) * SHIFT;
  const by = new Vector3(right * step, 0, down * step);
  scene.flat.position.add(by);
  scene.plan.target.add(by);
}

function zoom(scene, times) {
  if (scene.view === "plan") {
    scene.flat.zoom *= times;
    scene.flat.updateProjectionMatrix();
  } else {
    const { target } = scene.orbit;
    scene.perspective.position.sub(target).divideScalar(times).add(target);
  }
}

// Whether this key moved the camera: shift with an arrow, page up and down.
export function moved(scene, { key, shiftKey }) {
  if (shiftKey && ARROWS[key]) (scene.view === "plan" ? shift : turn)(scene, ARROWS[key]);
  else if (key === "PageUp" || key === "PageDown") zoom(scene, key === "PageUp" ? NEARER : 1 / NEARER);
  else return false;
  scene.kept = false; // as when a mouse moves it
  scene.dirty = true;
  return true;
}
