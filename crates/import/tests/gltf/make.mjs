// Makes the compressed files beside this one: rings of known shape, by the encoders that other programs use.
//
//     npm install draco3d@1.5.9 meshoptimizer@1.3.0 && node make.mjs
//
// A vertex at texture coordinates (u, v) lies on the ring where `at(u, v)` says; tests compute the same.
import draco3d from 'draco3d';
import { MeshoptEncoder } from 'meshoptimizer';
import { writeFileSync } from 'node:fs';

const [AROUND, ACROSS] = [24, 11];

/** Place, normal and colour on a ring of radius 2 and thickness 0.5 around the z axis. */
function at(u, v) {
  const [a, b] = [2 * Math.PI * u, 2 * Math.PI * v];
  const normal = [Math.cos(a) * Math.cos(b), Math.sin(a) * Math.cos(b), Math.sin(b)];
  const place = [2 * Math.cos(a), 2 * Math.sin(a), 0].map((c, i) => c + 0.5 * normal[i]);
  return { place, normal, color: [51, 102, 204, 255] };
}

const [places, normals, uvs, colors, indices] = [[], [], [], [], []];
for (let j = 0; j <= ACROSS; j++) {
  for (let i = 0; i <= AROUND; i++) {
    const [u, v] = [i / AROUND, j / ACROSS];
    const { place, normal, color } = at(u, v);
    places.push(...place), normals.push(...normal), uvs.push(u, v), colors.push(...color);
    if (i < AROUND && j < ACROSS) {
      const k = j * (AROUND + 1) + i;
      indices.push(k, k + 1, k + AROUND + 2, k, k + AROUND + 2, k + AROUND + 1);
    }
  }
}
const count = uvs.length / 2;

/** Appends bytes to a buffer at a multiple of four; the place and length. */
function append(chunks, bytes) {
  const byteOffset = chunks.length;
  chunks.push(...bytes, ...new Array((4 - (bytes.length % 4)) % 4).fill(0));
  return { byteOffset, byteLength: bytes.length };
}

function glb(name, json, binary) {
  const text = Buffer.from(JSON.stringify(json));
  const pad = (bytes, fill) => Buffer.concat([bytes, Buffer.alloc((4 - (bytes.length % 4)) % 4, fill)]);
  const chunk = (kind, bytes) => Buffer.concat([Buffer.from(Uint32Array.of(bytes.length).buffer), Buffer.from(kind), bytes]);
  const body = Buffer.concat([chunk('JSON', pad(text, ' ')), chunk('BIN\0', pad(Buffer.from(binary), 0))]);
  writeFileSync(name, Buffer.concat([Buffer.from('glTF'), Buffer.from(Uint32Array.of(2, 12 + body.length).buffer), body]));
}

const document = (extensions) => ({
  asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ name: 'Ring', mesh: 0 }],
  materials: [{ name: 'Blue', pbrMetallicRoughness: { metallicFactor: 0 } }],
  extensionsUsed: extensions, extensionsRequired: extensions,
});
const attributes = { POSITION: 0, NORMAL: 1, TEXCOORD_0: 2, COLOR_0: 3 };

/** By Google's encoder: edgebreaker or sequential, quantized, colours as a generic attribute. */
async function draco(name, method) {
  const d = await draco3d.createEncoderModule({});
  const [encoder, builder, mesh] = [new d.Encoder(), new d.MeshBuilder(), new d.Mesh()];
  builder.AddFacesToMesh(mesh, indices.length / 3, new Uint32Array(indices));
  builder.AddFloatAttributeToMesh(mesh, d.POSITION, count, 3, new Float32Array(places));
  builder.AddFloatAttributeToMesh(mesh, d.NORMAL, count, 3, new Float32Array(normals));
  builder.AddFloatAttributeToMesh(mesh, d.TEX_COORD, count, 2, new Float32Array(uvs));
  builder.AddUInt8Attribute(mesh, d.GENERIC, count, 4, new Uint8Array(colors));
  encoder.SetEncodingMethod(method === 'sequential' ? d.MESH_SEQUENTIAL_ENCODING : d.MESH_EDGEBREAKER_ENCODING);
  encoder.SetSpeedOptions(...(method === 'valence' ? [0, 0] : [7, 7]));
  encoder.SetAttributeQuantization(d.POSITION, 14);
  encoder.SetAttributeQuantization(d.NORMAL, 10);
  encoder.SetAttributeQuantization(d.TEX_COORD, 12);
  const out = new d.DracoInt8Array();
  const length = encoder.EncodeMeshToDracoBuffer(mesh, out);
  const bytes = Uint8Array.from({ length }, (_, i) => out.GetValue(i) & 255);
  const points = encoder.GetNumberOfEncodedPoints();
  const accessor = (componentType, type, n, more) => ({ componentType, type, count: n, ...more });
  glb(name, {
    ...document(['KHR_draco_mesh_compression']),
    meshes: [{ primitives: [{ attributes, indices: 4, material: 0,
      extensions: { KHR_draco_mesh_compression: { bufferView: 0, attributes } } }] }],
    accessors: [accessor(5126, 'VEC3', points), accessor(5126, 'VEC3', points), accessor(5126, 'VEC2', points),
      accessor(5121, 'VEC4', points, { normalized: true }), accessor(5123, 'SCALAR', indices.length)],
    bufferViews: [{ buffer: 0, byteLength: bytes.length }], buffers: [{ byteLength: bytes.length }],
  }, bytes);
}

/** By meshoptimizer's encoder; `parts` are the attributes, indices and instances as it should pack them. */
function meshopt(name, extension, parts, accessors, more = {}) {
  const [chunks, bufferViews] = [[], []];
  let byteOffset = 0;
  for (const { bytes, stride, mode, filter, version, target } of parts) {
    const n = bytes.length / stride;
    const packed = mode === 'ATTRIBUTES' ? MeshoptEncoder.encodeVertexBufferLevel(bytes, n, stride, 2, version)
      : MeshoptEncoder.encodeGltfBuffer(bytes, n, stride, mode);
    bufferViews.push({ buffer: 1, byteOffset, byteLength: bytes.length, ...(target === 34962 ? { byteStride: stride } : {}), target,
      extensions: { [extension]: { buffer: 0, ...append(chunks, packed), byteStride: stride, count: n, mode, filter } } });
    byteOffset += bytes.length;
  }
  glb(name, {
    ...document([extension, 'KHR_mesh_quantization', ...(more.nodes ? ['EXT_mesh_gpu_instancing'] : [])]),
    meshes: [{ primitives: [{ attributes, indices: 4, material: 0 }] }],
    accessors, bufferViews,
    buffers: [{ byteLength: chunks.length }, { byteLength: byteOffset, extensions: { [extension]: { fallback: true } } }], ...more,
  }, chunks);
}

const bytesOf = (typed) => new Uint8Array(typed.buffer, typed.byteOffset, typed.byteLength);
const accessor = (bufferView, componentType, type, n, more = {}) => ({ bufferView, componentType, type, count: n, ...more });
const four = (list, n, last) => Array.from({ length: list.length / n }, (_, i) => [...list.slice(n * i, n * i + n), ...last]).flat();

await draco('draco_edgebreaker.glb', 'edgebreaker');
await draco('draco_valence.glb', 'valence');
await draco('draco_sequential.glb', 'sequential');

await MeshoptEncoder.ready;
const vertex = (typed, stride, more) => ({ bytes: bytesOf(typed), stride, mode: 'ATTRIBUTES', target: 34962, version: 0, ...more });
meshopt('meshopt_ext.glb', 'EXT_meshopt_compression', [
  vertex(new Float32Array(places), 12),
  vertex(MeshoptEncoder.encodeFilterOct(new Float32Array(four(normals, 3, [0])), count, 4, 8), 4, { filter: 'OCTAHEDRAL' }),
  vertex(Uint16Array.from(uvs, (v) => Math.round(v * 65535)), 4),
  vertex(new Uint8Array(colors), 4),
  { bytes: bytesOf(new Uint16Array(indices)), stride: 2, mode: 'TRIANGLES', target: 34963 },
], [accessor(0, 5126, 'VEC3', count), accessor(1, 5120, 'VEC3', count, { normalized: true }),
  accessor(2, 5123, 'VEC2', count, { normalized: true }), accessor(3, 5121, 'VEC4', count, { normalized: true }),
  accessor(4, 5123, 'SCALAR', indices.length)]);

const half = Math.SQRT1_2;
meshopt('meshopt_khr.glb', 'KHR_meshopt_compression', [
  vertex(MeshoptEncoder.encodeFilterExp(new Float32Array(places), count, 12, 15), 12, { filter: 'EXPONENTIAL', version: 1 }),
  vertex(MeshoptEncoder.encodeFilterOct(new Float32Array(four(normals, 3, [0])), count, 8, 12), 8, { filter: 'OCTAHEDRAL', version: 1 }),
  vertex(new Float32Array(uvs), 8, { version: 1 }),
  vertex(MeshoptEncoder.encodeFilterColor(new Float32Array(colors.map((c) => c / 255)), count, 4, 8), 4, { filter: 'COLOR', version: 1 }),
  { bytes: bytesOf(new Uint32Array(indices)), stride: 4, mode: 'INDICES', target: 34963 },
  vertex(MeshoptEncoder.encodeFilterQuat(new Float32Array([0, 0, 0, 1, 0, half, 0, half]), 2, 8, 12), 8,
    { filter: 'QUATERNION', version: 1, target: undefined }),
], [accessor(0, 5126, 'VEC3', count), accessor(1, 5122, 'VEC3', count, { normalized: true }), accessor(2, 5126, 'VEC2', count),
  accessor(3, 5121, 'VEC4', count, { normalized: true }), accessor(4, 5125, 'SCALAR', indices.length),
  accessor(5, 5122, 'VEC4', 2, { normalized: true })],
{ nodes: [{ name: 'Ring', mesh: 0, extensions: { EXT_mesh_gpu_instancing: { attributes: { ROTATION: 5 } } } }] });
