// Vehicles, trails and tracks: instanced meshes and one buffer of lines, whatever their number.
import {
  BufferAttribute, BufferGeometry, Color, ConeGeometry, DynamicDrawUsage, Group, InstancedMesh, LineBasicMaterial,
  LineSegments, MeshBasicMaterial, MeshLambertMaterial, Object3D, SphereGeometry, BoxGeometry, CylinderGeometry,
} from "three";

const TRAIL = 240; // pieces of way that are kept of each
const PIECE_M = 0.5; // a shorter piece is not drawn anew
const SIGMAS = 2; // of the ellipsoids of tracks

// A body that points north (−z) and is one metre long.
function body(kind) {
  if (kind === "evader") {
    const geometry = new CylinderGeometry(0, 0.42, 1, 4);
    geometry.rotateX(-Math.PI / 2);
    return geometry;
  }
  if (kind === "tracker") return new BoxGeometry(0.6, 0.3, 0.6);
  const geometry = new ConeGeometry(0.3, 1, 12);
  geometry.rotateX(-Math.PI / 2);
  return geometry;
}

export class Fleet {
  constructor() {
    this.group = new Group();
    this.meshes = {};
    this.capacity = 0;
    this.trails = new Map(); // id → {slot, head, last}
    this.free = 0;
    this.vehicles = [];
    this.tracks = [];
    this.one = new Object3D();
    this.one.rotation.order = "YXZ";
    this.grow(16);
  }

  grow(capacity) {
    for (const mesh of Object.values(this.meshes)) {
      this.group.remove(mesh);
      mesh.dispose();
    }
    this.capacity = capacity;
    for (const kind of ["evader", "pursuer", "tracker"]) {
      const mesh = new InstancedMesh(body(kind), new MeshLambertMaterial({ color: 0xffffff }), capacity);
      mesh.instanceMatrix.setUsage(DynamicDrawUsage);
      mesh.frustumCulled = false;
      mesh.count = 0;
      this.meshes[kind] = mesh;
      this.group.add(mesh);
    }
    const ellipsoid = new SphereGeometry(1, 20, 12);
    const veil = new MeshBasicMaterial({ transparent: true, opacity: 0.22, depthWrite: false });
    this.meshes.track = new InstancedMesh(ellipsoid, veil, capacity);
    this.meshes.track.frustumCulled = false;
    this.meshes.track.count = 0;
    this.group.add(this.meshes.track);
    if (this.lines) {
      this.group.remove(this.lines);
      this.lines.geometry.dispose();
    }
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(capacity * TRAIL * 6), 3).setUsage(DynamicDrawUsage));
    geometry.setAttribute("color", new BufferAttribute(new Float32Array(capacity * TRAIL * 6), 3).setUsage(DynamicDrawUsage));
    this.lines = new LineSegments(geometry, new LineBasicMaterial({ vertexColors: true, transparent: true, opacity: 0.75 }));
    this.lines.frustumCulled = false;
    this.group.add(this.lines);
    if (this.drops) {
      this.group.remove(this.drops);
      this.drops.geometry.dispose();
    }
    const feet = new BufferGeometry();
    feet.setAttribute("position", new BufferAttribute(new Float32Array(capacity * 6), 3).setUsage(DynamicDrawUsage));
    this.drops = new LineSegments(feet, new LineBasicMaterial({ transparent: true, opacity: 0.45 }));
    this.drops.frustumCulled = false;
    this.group.add(this.drops);
    const ways = this.ways();
    this.trails.clear();
    this.free = 0;
    for (const [key, points] of ways) this.way(key, points);
  }

  // From each vehicle straight down to the ground, so that heights can be read.
  showDrops(vehicles) {
    const { position } = this.drops.geometry.attributes;
    vehicles.slice(0, this.capacity).forEach((v, i) => position.array.set([v.x, v.y, v.z, v.x, 0, v.z], 6 * i));
    this.drops.geometry.setDrawRange(0, 2 * Math.min(vehicles.length, this.capacity));
    this.drops.material.color.set(this.colours.faint);
    position.needsUpdate = true;
  }

  // All ways as lists of places, for a larger buffer or another theme.
  ways() {
    return [...this.trails].map(([key, trail]) => [key, trail.points]);
  }

  setColours(colours) {
    this.colours = colours;
    const ways = this.ways();
    this.trails.clear();
    this.free = 0;
    this.lines.geometry.attributes.position.array.fill(0);
    this.lines.geometry.attributes.position.needsUpdate = true;
    for (const [key, points] of ways) this.way(key, points);
    if (this.vehicles.length) this.show(this.vehicles, this.tracks, this.scale, this.roles);
  }

  // Replace one way: key is `v2` or `t1`, points are [x, y, z].
  way(key, points) {
    this.trails.delete(key);
    for (const point of points) this.extend(key, point);
  }

  forgetWays() {
    this.trails.clear();
    this.free = 0;
    this.lines.geometry.attributes.position.array.fill(0);
    this.lines.geometry.attributes.position.needsUpdate = true;
  }

  extend(key, point) {
    let trail = this.trails.get(key);
    if (!trail) {
      if (this.free >= this.capacity) return;
      trail = { slot: this.free, head: 0, points: [] };
      this.free += 1;
      this.trails.set(key, trail);
    }
    const last = trail.points[trail.points.length - 1];
    if (last) {
      const moved = Math.hypot(point[0] - last[0], point[1] - last[1], point[2] - last[2]);
      if (moved < PIECE_M) return;
      const at = (trail.slot * TRAIL + (trail.head % TRAIL)) * 6;
      const { position, color } = this.lines.geometry.attributes;
      position.array.set([...last, ...point], at);
      const shade = new Color(this.colours ? this.colourOf(key) : "#888888");
      color.array.set([shade.r, shade.g, shade.b, shade.r, shade.g, shade.b], at);
      position.addUpdateRange(at, 6);
      color.addUpdateRange(at, 6);
      position.needsUpdate = true;
      color.needsUpdate = true;
      trail.head += 1;
    }
    trail.points.push(point);
    if (trail.points.length > TRAIL) trail.points.shift();
  }

  colourOf(key) {
    const id = Number(key.slice(1));
    if (key[0] === "t") return this.colours.faint;
    const vehicle = this.vehicles.find((v) => v.id === id);
    return this.colours.vehicle(id, (vehicle && this.roles && this.roles[vehicle.role] === "evader") || id === 1);
  }

  // Show these; `scale(x, y, z)` is the size of a body there [m].
  show(vehicles, tracks, scale, roles) {
    Object.assign(this, { vehicles, tracks, scale, roles });
    const need = Math.max(vehicles.length + tracks.length, tracks.length);
    if (need > this.capacity) this.grow(Math.max(need, 2 * this.capacity));
    const counts = { evader: 0, pursuer: 0, tracker: 0 };
    const shade = new Color();
    for (const v of vehicles) {
      const kind = counts[roles[v.role]] === undefined ? "pursuer" : roles[v.role];
      const mesh = this.meshes[kind];
      this.one.position.set(v.x, v.y, v.z);
      this.one.rotation.set(v.pitch, -v.yaw, -v.roll);
      this.one.scale.setScalar(scale(v.x, v.y, v.z));
      this.one.updateMatrix();
      mesh.setMatrixAt(counts[kind], this.one.matrix);
      shade.set(v.fed ? this.colours.vehicle(v.id, kind === "evader") : this.colours.faint);
      mesh.setColorAt(counts[kind], shade);
      counts[kind] += 1;
    }
    for (const kind of Object.keys(counts)) {
      const mesh = this.meshes[kind];
      mesh.count = counts[kind];
      mesh.instanceMatrix.needsUpdate = true;
      if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
    }
    this.showTracks(tracks, scale);
    this.showDrops(vehicles);
  }

  showTracks(tracks, scale) {
    const mesh = this.meshes.track;
    const shade = new Color(this.colours.evader);
    tracks.forEach((t, i) => {
      const least = 0.25 * scale(t.x, t.y, t.z);
      this.one.position.set(t.x, t.y, t.z);
      this.one.rotation.set(0, 0, 0);
      const radius = (sigma) => Math.max(Number.isFinite(sigma) ? SIGMAS * sigma : least, least);
      this.one.scale.set(radius(t.sx), radius(t.sy), radius(t.sz));
      this.one.updateMatrix();
      mesh.setMatrixAt(i, this.one.matrix);
      mesh.setColorAt(i, shade);
    });
    mesh.count = tracks.length;
    mesh.instanceMatrix.needsUpdate = true;
    if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
  }
}
