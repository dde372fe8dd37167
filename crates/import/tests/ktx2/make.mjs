// Makes the pictures beside this file, by Basis Universal's encoder in WebAssembly.
//
//     npm install ktx2-encoder@0.6.0 && node make.mjs
import { encodeToKTX2 } from 'ktx2-encoder';
import { writeFileSync } from 'node:fs';

const [width, height] = [24, 18];

/** A ramp of red to the right and of green downwards; tests compute the same. */
function picture(withAlpha) {
  const data = new Uint8Array(4 * width * height);
  for (let i = 0; i < width * height; i++) {
    const [x, y] = [i % width, Math.floor(i / width)];
    data.set([10 * x, 14 * y, 128, withAlpha ? 255 - 8 * x : 255], 4 * i);
  }
  return data;
}

const options = { generateMipmap: false, isPerceptual: true, isSetKTX2SRGBTransferFunc: true };
for (const [name, alpha, more] of [
  ['etc1s.ktx2', false, { isUASTC: false, qualityLevel: 255, generateMipmap: true }],
  ['etc1s_alpha.ktx2', true, { isUASTC: false, qualityLevel: 255 }],
  ['uastc.ktx2', false, { isUASTC: true, needSupercompression: false }],
  ['uastc_alpha_zstd.ktx2', true, { isUASTC: true, needSupercompression: true, generateMipmap: true }],
]) {
  const imageDecoder = async () => ({ data: picture(alpha), width, height });
  writeFileSync(name, await encodeToKTX2(new Uint8Array(1), { ...options, ...more, imageDecoder }));
}
