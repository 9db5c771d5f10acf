// The user's own map on the ground: tiles of Web Mercator, put into the game's frame around its origin.
import { BufferGeometry, Float32BufferAttribute, Group, Mesh, MeshBasicMaterial, TextureLoader } from "three";

const A = 6378137; // WGS 84
const E2 = 6.69437999014e-3;
const RAD = Math.PI / 180;
const LINEAR = 1006; // three.js's LinearFilter: about one texel a pixel, smaller ones are not needed
const TILE_PX = 256;
const TILES_MOST = 48; // drawn at once
const PARTS = 4; // of a tile's side: Mercator is no plane
const LOOK_MS = 200;

// Latitude and longitude [°] of a place on the map: x and y in tiles of a zoom, y to the south.
export function degreesOf(zoom, x, y) {
  const count = 2 ** zoom;
  return [Math.atan(Math.sinh(Math.PI * (1 - (2 * y) / count))) / RAD, (360 * x) / count - 180];
}

export function tileOf(zoom, latitude, longitude) {
  const count = 2 ** zoom;
  return [((longitude + 180) / 360) * count, (0.5 - Math.asinh(Math.tan(latitude * RAD)) / (2 * Math.PI)) * count];
}

function centred(latitude, longitude, height) {
  const [sin, cos] = [Math.sin(latitude * RAD), Math.cos(latitude * RAD)];
  const n = A / Math.sqrt(1 - E2 * sin * sin);
  return [
    (n + height) * cos * Math.cos(longitude * RAD), (n + height) * cos * Math.sin(longitude * RAD),
    (n * (1 - E2) + height) * sin,
  ];
}

// North and east [m] of a place at the origin's height, in the plane that touches the Earth at the origin.
export function northEast([latitude, longitude, height], [lat, lon]) {
  const [from, to] = [centred(latitude, longitude, height), centred(lat, lon, height)];
  const [dx, dy, dz] = to.map((value, i) => value - from[i]);
  const [sl, cl] = [Math.sin(longitude * RAD), Math.cos(longitude * RAD)];
  const [sp, cp] = [Math.sin(latitude * RAD), Math.cos(latitude * RAD)];
  return [-sp * cl * dx - sp * sl * dy + cp * dz, -sl * dx + cl * dy];
}

// The inverse near the origin, by Newton's steps on the sphere.
export function latLon(origin, [north, east]) {
  let place = [origin[0], origin[1]];
  for (let i = 0; i < 4; i += 1) {
    const found = northEast(origin, place);
    const step = [(north - found[0]) / A / RAD, (east - found[1]) / A / RAD / Math.cos(place[0] * RAD)];
    place = [Math.max(-85, Math.min(85, place[0] + step[0])), place[1] + step[1]];
  }
  return place;
}

export class GroundMap {
  // `about`: {zooms, bounds} of the server's map; it draws into `scene` whatever lies in its view.
  constructor(scene, about) {
    this.scene = scene;
    this.about = about;
    this.group = new Group();
    this.tiles = new Map(); // by "z/x/y": a mesh, or null while it loads and where there is none
    this.loader = new TextureLoader();
    this.origin = null;
    scene.world.add(this.group);
    setInterval(() => this.look(), LOOK_MS);
  }

  show(on) {
    this.group.visible = on;
    this.scene.dirty = true;
  }

  setOrigin(origin) {
    if (JSON.stringify(origin) === JSON.stringify(this.origin)) return;
    this.origin = origin;
    this.forget(() => true);
  }

  setDark(dark) {
    this.tint = dark ? 0x8c8c8c : 0xffffff;
    for (const mesh of this.group.children) mesh.material.color.set(this.tint);
    this.scene.dirty = true;
  }

  look() {
    if (!this.origin || !this.group.visible) return;
    const wanted = this.wanted();
    let loading = false;
    for (const [z, x, y] of wanted) {
      const key = `${z}/${x}/${y}`;
      if (!this.tiles.has(key)) this.load(key, z, x, y);
      loading = loading || this.tiles.get(key) === undefined;
    }
    const keys = new Set(wanted.map((tile) => tile.join("/")));
    if (!loading || this.tiles.size > 4 * TILES_MOST) this.forget((key) => !keys.has(key)); // the old ones stay until the new ones are there
  }

  // The tiles around what the camera looks at: the finest zoom that the screen shows, few enough.
  wanted() {
    const { x, y, z } = this.scene.controls.target;
    const perPixel = this.scene.metresPerPixel(x, y, z);
    const host = this.scene.host;
    const half = 0.75 * perPixel * Math.max(host.clientWidth, host.clientHeight) * (this.scene.view === "plan" ? 1 : 1.6);
    const [least, most] = this.about.zooms;
    const fine = Math.log2((2 * Math.PI * A * Math.cos(this.origin[0] * RAD)) / TILE_PX / perPixel);
    for (let zoom = Math.max(least, Math.min(most, Math.ceil(fine))); zoom >= least; zoom -= 1) {
      const found = this.around(zoom, [-z, x], half);
      if (found) return found;
    }
    return [];
  }

  // Null where they are too many.
  around(zoom, [north, east], half) {
    const [west, south, far, top] = this.about.bounds;
    const low = latLon(this.origin, [north - half, east - half]);
    const high = latLon(this.origin, [north + half, east + half]);
    if (low[1] > far || high[1] < west || low[0] > top || high[0] < south) return [];
    const [x0, y1] = tileOf(zoom, Math.max(low[0], south), Math.max(low[1], west)).map(Math.floor);
    const [x1, y0] = tileOf(zoom, Math.min(high[0], top), Math.min(high[1], far)).map(Math.floor);
    if ((x1 - x0 + 1) * (y1 - y0 + 1) > TILES_MOST) return null;
    const found = [];
    for (let x = x0; x <= x1; x += 1) for (let y = y0; y <= y1; y += 1) found.push([zoom, x, y]);
    return found;
  }

  load(key, z, x, y) {
    this.tiles.set(key, undefined);
    const { origin } = this;
    const drop = () => { if (this.tiles.get(key) === undefined) this.tiles.set(key, null); };
    this.loader.load(`/tiles/${key}`, (texture) => {
      if (origin !== this.origin || !this.tiles.has(key) || this.tiles.get(key)) {
        texture.dispose();
        return;
      }
      texture.colorSpace = "srgb";
      texture.generateMipmaps = false;
      texture.minFilter = LINEAR;
      const material = new MeshBasicMaterial({ map: texture, color: this.tint || 0xffffff, depthWrite: false });
      const mesh = new Mesh(this.surface(z, x, y), material);
      mesh.name = key;
      mesh.renderOrder = z - 100; // below everything, finer ones above coarser ones
      this.tiles.set(key, mesh);
      this.group.add(mesh);
      this.scene.dirty = true;
    }, undefined, drop);
  }

  surface(z, x, y) {
    const [at, uv, faces] = [[], [], []];
    for (let j = 0; j <= PARTS; j += 1) {
      for (let i = 0; i <= PARTS; i += 1) {
        const [north, east] = northEast(this.origin, degreesOf(z, x + i / PARTS, y + j / PARTS));
        at.push(east, 0, -north);
        uv.push(i / PARTS, 1 - j / PARTS);
        if (i === PARTS || j === PARTS) continue;
        const k = j * (PARTS + 1) + i;
        faces.push(k, k + PARTS + 1, k + 1, k + 1, k + PARTS + 1, k + PARTS + 2);
      }
    }
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new Float32BufferAttribute(at, 3));
    geometry.setAttribute("uv", new Float32BufferAttribute(uv, 2));
    geometry.setIndex(faces);
    return geometry;
  }

  forget(which) {
    for (const [key, mesh] of [...this.tiles]) {
      if (!which(key)) continue;
      this.tiles.delete(key);
      if (!mesh) continue;
      this.group.remove(mesh);
      mesh.geometry.dispose();
      mesh.material.map.dispose();
      mesh.material.dispose();
      this.scene.dirty = true;
    }
  }
}
