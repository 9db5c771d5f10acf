// What stands still: grid, fence, target, and the shapes of the selected vehicle's decision.
import {
  BufferAttribute, BufferGeometry, ConeGeometry, DynamicDrawUsage, Float32BufferAttribute, GridHelper, Group, Line,
  LineBasicMaterial, LineDashedMaterial, LineLoop, LineSegments, Mesh, RingGeometry, SphereGeometry, Vector3,
} from "three";
import { place } from "frames";
import { isEvader } from "colours";
import { dashes, dots, faded, paint, plain, tint, veil } from "paint";

function points(list) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute(list.flat(), 3));
  return geometry;
}

// A line in dashes of `dash` metres.
function dashed(line, dash) {
  line.computeLineDistances();
  const { array } = line.geometry.attributes.lineDistance;
  for (let i = 0; i < array.length; i += 1) array[i] /= dash;
  return line;
}

function circle(radius, [x, y, z], colour, broken = false) {
  const list = [];
  for (let i = 0; i <= 96; i += 1) {
    const a = (i / 96) * 2 * Math.PI;
    list.push([x + radius * Math.sin(a), y, z - radius * Math.cos(a)]);
  }
  if (!broken) return new Line(points(list), plain(colour));
  return dashed(new Line(points(list), dashes(colour)), radius / 8);
}

function clear(group) {
  for (const child of [...group.children]) {
    group.remove(child);
    child.traverse((each) => {
      if (each.geometry) each.geometry.dispose();
    });
  }
}

// A band along a way, so many σ to each side over the ground.
function strip(way, times) {
  const sides = way.map(({ at, sigma }, i) => {
    const before = way[Math.max(0, i - 1)].at;
    const after = way[Math.min(way.length - 1, i + 1)].at;
    const [dx, dz] = [after[0] - before[0], after[2] - before[2]];
    const length = Math.hypot(dx, dz) || 1;
    const [u, w] = [(-dz / length) * sigma * times, (dx / length) * sigma * times];
    return [[at[0] + u, at[1], at[2] + w], [at[0] - u, at[1], at[2] - w]];
  });
  return points(sides.slice(1).flatMap(([left, right], i) => [sides[i][0], sides[i][1], left, sides[i][1], right, left]));
}

// The head of an arrow over the ground: from one side over the tip to the other.
function arrow(tip, [x, y, z], half) {
  const [dx, dz] = [tip[0] - x, tip[2] - z];
  const long = Math.hypot(dx, dz) || 1;
  const side = [(-dz / long) * half, (dx / long) * half];
  return [[x + side[0], y, z + side[1]], tip, [x - side[0], y, z - side[1]]];
}

export function round(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  const step = [1, 2, 5, 10].find((s) => s * power >= value * 0.999999);
  return step * power;
}

export class Ground {
  constructor() {
    this.group = new Group();
    this.still = new Group();
    this.near = new Group(); // spheres around evaders
    this.evaders = new Map(); // where they are
    this.chases = new Group();
    this.arcs = new Group(); // relations of what the team knows
    this.named = []; // their words and places
    this.zones = [];
    this.chosen = new Group(); // of the selected vehicle
    const aiming = new LineDashedMaterial({ vertexColors: true, transparent: true, dashSize: 1, gapSize: 0.6 });
    this.aims = new LineSegments(new BufferGeometry(), aiming); // in one drawing, whatever their number
    this.aims.frustumCulled = false;
    this.aims.visible = false;
    this.aimsRoom = 0;
    this.gaps = new Group();
    this.fans = new Group();
    this.expected = []; // places at the fans' marks, for labels
    this.group.add(this.still, this.near, this.chosen, this.aims, this.chases, this.arcs, this.gaps, this.fans);
  }

  setColours(colours) {
    this.colours = colours;
    if (this.field) this.setField(this.field, this.reach);
  }

  setField(field, reach) {
    this.field = field;
    this.reach = reach;
    clear(this.still);
    clear(this.near);
    this.zones = []; // names and their places
    const { colours } = this;
    const cell = round(reach / 10);
    const grid = new GridHelper(cell * 40, 40, colours.faint, colours.grid);
    grid.material.dispose();
    grid.material = paint(`grid ${colours.dark}`, () => new LineBasicMaterial({ vertexColors: true, transparent: true, opacity: colours.dark ? 0.5 : 0.9 }));
    this.still.add(grid);
    if (field.fence) this.drawWalls(field.fence, colours.fence, 0.08);
    for (const zone of field.zones) this.drawZone(zone);
    for (const goal of field.targets) this.drawTarget(field, goal.place);
    this.setEvaders(this.evaders);
  }

  shell(radius, colour, planar, dashed) {
    const group = new Group();
    group.add(circle(radius, [0, 0, 0], colour, dashed));
    if (!planar) group.add(new Mesh(new SphereGeometry(radius, 32, 20), veil(colour, dashed ? 0.06 : 0.14)));
    return group;
  }

  // The walls of a prism.
  drawWalls({ polygon, floor, ceiling }, colour, opacity) {
    const corners = polygon.map(([north, east]) => [east, -north]);
    for (const height of new Set([floor, ceiling])) {
      this.still.add(new LineLoop(points(corners.map(([x, z]) => [x, height, z])), plain(colour)));
    }
    if (floor === ceiling) return;
    corners.forEach(([x, z], i) => {
      const [u, w] = corners[(i + 1) % corners.length];
      const wall = points([[x, floor, z], [u, floor, w], [u, ceiling, w], [x, floor, z], [u, ceiling, w], [x, ceiling, z]]);
      this.still.add(new Mesh(wall, veil(colour, opacity)));
      this.still.add(new Line(points([[x, floor, z], [x, ceiling, z]]), plain(colour)));
    });
  }

  // A zone with its floor and ceiling. Without an end it is as high as the fence, or as what is seen; of a plane game
  // half as high again as it is flown, and flat where that is on the ground.
  drawZone(zone) {
    const { colours, field, reach } = this;
    const floor = zone.floor === null ? 0 : zone.floor;
    const flown = Math.max(0, ...(field.roster || []).map(({ start }) => (start ? -start[2] : 0)));
    const high = field.planar ? 1.5 * flown : field.fence ? field.fence.ceiling : round(reach / 2);
    const ceiling = zone.ceiling === null || field.planar ? Math.max(floor, high) : zone.ceiling;
    this.drawWalls({ polygon: zone.polygon, floor, ceiling }, colours.zone, 0.2);
    const corners = zone.polygon.map(([north, east]) => [east, -north]);
    for (const height of new Set([floor, ceiling])) {
      const [first, ...others] = corners.map(([x, z]) => [x, height, z]); // it is convex
      const lid = others.slice(1).flatMap((corner, i) => [first, others[i], corner]);
      this.still.add(new Mesh(points(lid), veil(colours.zone, 0.2)));
    }
    const middle = [0, 1].map((axis) => corners.reduce((sum, corner) => sum + corner[axis], 0) / corners.length);
    this.zones.push({ name: zone.name, at: [middle[0], ceiling, middle[1]] });
  }

  drawTarget(field, goal) {
    const [x, y, z] = place(goal);
    const { colours } = this;
    const radius = Math.max(field.capture || 0, this.reach / 60);
    const disc = new Mesh(new RingGeometry(radius * 0.7, radius, 48), veil(colours.target, 0.9));
    disc.rotation.x = -Math.PI / 2;
    disc.position.set(x, y, z);
    this.still.add(disc);
    this.still.add(new Line(points([[x, 0, z], [x, y, z]]), plain(colours.target)));
    for (const [dx, dz] of [[radius, 0], [0, radius]]) {
      this.still.add(new Line(points([[x - dx, y, z - dz], [x + dx, y, z + dz]]), plain(colours.target)));
    }
  }

  // Where evaders are, by id, for their spheres.
  setEvaders(evaders) {
    this.evaders = evaders;
    if (!this.field || !this.colours) return;
    const { capture, safety, planar } = this.field;
    while (this.near.children.length < evaders.size) {
      const spheres = new Group();
      if (capture) spheres.add(this.shell(capture, this.colours.capture, planar, false));
      if (safety) spheres.add(this.shell(safety, this.colours.safety, planar, true));
      this.near.add(spheres);
    }
    const places = [...evaders.values()];
    this.near.children.forEach((spheres, i) => {
      spheres.visible = i < places.length;
      if (spheres.visible) spheres.position.set(...places[i]);
    });
  }

  // Thin lines from each pursuer to the evader that it is after, where there are several.
  setChases(after, where) {
    clear(this.chases);
    for (const [id, evader] of after) {
      const [from, to] = [where.get(id), where.get(evader) || this.evaders.get(evader)];
      if (!from || !to) continue;
      this.chases.add(dashed(new Line(points([from, to]), dots(this.colours.vehicle(evader, true))), this.reach / 150));
    }
  }

  // All aims in one drawing; that of the selected vehicle is opaque, and its place marked.
  setAims(aims, where, selected) {
    this.aims.visible = aims.length > 0;
    if (!this.aims.visible) return;
    this.roomForAims(aims.length + 2);
    const { position, color, lineDistance } = this.aims.geometry.attributes;
    let count = 0;
    const segment = (from, to, shade, alpha, dash) => {
      position.array.set([...from, ...to], 6 * count);
      color.array.set([shade.r, shade.g, shade.b, alpha, shade.r, shade.g, shade.b, alpha], 8 * count);
      lineDistance.array.set([0, Math.hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]) / dash], 2 * count);
      count += 1;
    };
    for (const aim of aims) {
      const from = where.get(aim.id);
      if (!from) continue;
      const to = place(aim.aim);
      const shade = tint(this.colours.vehicle(aim.id, aim.evader));
      segment(from, to, shade, aim.id === selected ? 1 : 0.45, this.reach / 90);
      if (aim.id !== selected) continue;
      const mark = this.reach / 120;
      for (const side of [mark, -mark]) segment([to[0] - mark, to[1], to[2] - side], [to[0] + mark, to[1], to[2] + side], shade, 1, 1e9);
    }
    this.aims.geometry.setDrawRange(0, 2 * count);
    for (const each of [position, color, lineDistance]) each.needsUpdate = true;
  }

  roomForAims(need) {
    if (need <= this.aimsRoom) return;
    this.aimsRoom = 2 * need;
    this.aims.geometry.dispose();
    const geometry = new BufferGeometry();
    for (const [name, size] of [["position", 3], ["color", 4], ["lineDistance", 1]]) {
      geometry.setAttribute(name, new BufferAttribute(new Float32Array(this.aimsRoom * 2 * size), size).setUsage(DynamicDrawUsage));
    }
    this.aims.geometry = geometry;
  }

  // Relations as arcs that rise over the line between their ends and swing to its left, so that two that lead
  // to and fro keep apart; the stronger, the less faint.
  setArcs(arcs) {
    clear(this.arcs);
    this.named = [];
    for (const arc of arcs) {
      const [from, to] = [place(arc.from), place(arc.to)];
      const line = to.map((end, axis) => end - from[axis]);
      const length = Math.hypot(...line);
      const over = [line[2] * 0.12, this.field && this.field.planar ? 0 : length * 0.12, -line[0] * 0.12];
      const at = (t) => from.map((start, axis) => start + t * line[axis] + 4 * t * (1 - t) * over[axis]);
      const way = Array.from({ length: 25 }, (_, i) => at(i / 24));
      const colour = arc.source ? this.colours.vehicle(arc.source, isEvader(arc.source)) : this.colours.force;
      this.arcs.add(new Line(points(way), faded(colour, 0.4 + 0.2 * Math.round(3 * arc.strength))));
      this.arcs.add(new Line(points(arrow(at(0.9), at(0.84), length * 0.02)), faded(colour, 1)));
      this.named.push({ words: arc.words, at: at(0.5) });
    }
  }

  setGaps(judged) {
    clear(this.gaps);
    if (!this.field) return;
    for (const { evader, gaps } of judged) {
      if (this.evaders.has(evader)) this.drawGaps(gaps, this.evaders.get(evader));
    }
  }

  drawGaps(gaps, [x, y, z]) {
    const radius = Math.max((this.field.safety || 0) * 1.6, this.reach / 12);
    for (const [start, width] of gaps) {
      const ring = new RingGeometry(radius * 0.82, radius, 48, 1, Math.PI / 2 - start - width, width);
      const mesh = new Mesh(ring, veil(this.colours.free, 0.55));
      mesh.rotation.x = -Math.PI / 2;
      mesh.position.set(x, y, z);
      this.gaps.add(mesh);
    }
  }

  // Where tracks will be: the mean way, and how far off 1σ and 2σ are; rings at the marks [s].
  setFans(fans, marks) {
    clear(this.fans);
    this.expected = [];
    if (!this.colours) return;
    for (const fan of fans) {
      const colour = this.colours.vehicle(fan.id, true);
      const way = fan.rows.map(([after, n, e, d, sigma]) => ({ after, sigma, at: place([n, e, d]) }));
      this.fans.add(new Line(points(way.map((each) => each.at)), plain(colour)));
      for (const times of [1, 2]) this.fans.add(new Mesh(strip(way, times), veil(colour, 0.16)));
      for (const each of way.filter(({ after }) => marks.includes(after))) {
        this.expected.push(each);
        this.fans.add(circle(each.sigma, each.at, colour), circle(2 * each.sigma, each.at, colour, true));
      }
    }
  }

  setDecision(decision, from) {
    clear(this.chosen);
    if (!decision || !from) return;
    const { colours } = this;
    const length = this.reach / 3;
    for (const [n, e, d, half] of decision.cones) {
      const axis = new Vector3(...place([n, e, d])).normalize();
      if (axis.lengthSq() === 0) continue;
      const open = Math.min(half, Math.PI / 2 - 0.01);
      if (this.field && this.field.planar) {
        const heading = Math.atan2(e, n);
        const sector = new RingGeometry(0, length, 32, 1, Math.PI / 2 - heading - half, 2 * half);
        const mesh = new Mesh(sector, veil(colours.cone, 0.22));
        mesh.rotation.x = -Math.PI / 2;
        mesh.position.set(...from);
        const [x, y, z] = from;
        const edge = (angle) => [x + length * Math.sin(angle), y, z - length * Math.cos(angle)];
        const edges = points([edge(heading - half), from, edge(heading + half)]);
        this.chosen.add(mesh, new Line(edges, plain(colours.cone)));
      } else {
        const height = length * Math.cos(open);
        const cone = new ConeGeometry(length * Math.sin(open), height, 40, 1, true);
        cone.translate(0, -height / 2, 0);
        const mesh = new Mesh(cone, veil(colours.cone, 0.16));
        mesh.quaternion.setFromUnitVectors(new Vector3(0, -1, 0), axis);
        mesh.position.set(...from);
        const rim = circle(length * Math.sin(open), [0, -height, 0], colours.cone);
        rim.quaternion.copy(mesh.quaternion);
        rim.position.copy(mesh.position);
        this.chosen.add(mesh, rim);
      }
    }
    for (const [n, e, d, radius] of decision.circles) {
      if (!(radius < 50 * this.reach)) continue;
      const centre = place([n, e, d]);
      this.chosen.add(circle(radius, centre, colours.apollonius));
      if (this.field && !this.field.planar) {
        const opacity = 0.1 / Math.max(1, decision.circles.length); // many lie over each other
        const sphere = new Mesh(new SphereGeometry(radius, 40, 24), veil(colours.apollonius, opacity));
        sphere.position.set(...centre);
        this.chosen.add(sphere);
      }
    }
  }
}
