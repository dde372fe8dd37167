// The triangles of a scene: blocks of faces in display order, each uploaded when it is first drawn.

import { BufferAttribute, BufferGeometry, GLSL3, DoubleSide, Mesh, RawShaderMaterial, Scene, Vector3 } from "../../vendor/three.js";
import { FACE_WIDTH, meshFragment, meshVertex } from "./shaders.js";
import { numbers } from "./tables.js";

/** Faces of a block: 6 MB of positions, which are uploaded in a short time. */
const BLOCK_FACES = FACE_WIDTH * 512;

/** The place of a face that is not here. */
const NOWHERE = 0xffffffff;

/** The ends of a box that clips nothing, metres. */
const FAR = 3e38;

/** The mesh in a three.js scene of its own, because it is drawn into a target of integers. */
export class SceneMesh {
    /**
     * @param {import("./geometry.js").Geometry} geometry
     * @param {import("./tables.js").Tables} tables
     */
    constructor(geometry, tables) {
        this.geometry = geometry;
        this.scene = new Scene();
        const { min, max } = geometry;
        this.shared = {
            boundsMin: { value: new Vector3(...min) },
            boundsSize: { value: new Vector3(max[0] - min[0], max[1] - min[1], max[2] - min[2]) },
            pieceFlags: { value: tables.flagTexture },
            upInView: { value: new Vector3() },
            wireframe: { value: false },
            clipMin: { value: new Vector3(-FAR, -FAR, -FAR) },
            clipMax: { value: new Vector3(FAR, FAR, FAR) },
        };
        /** @type {Mesh<BufferGeometry, RawShaderMaterial>[]} */
        this.blocks = [];
        for (let start = 0; start < geometry.faces; start += BLOCK_FACES) this.blocks.push(this.block(start));
        this.scene.add(...this.blocks);
        /** @type {Uint32Array | null} */
        this.places = null;
    }

    /** @param {number} start */
    block(start) {
        const { positions, pieceOfFace, faceNumbers, faces } = this.geometry;
        const end = Math.min(start + BLOCK_FACES, faces);
        const buffer = new BufferGeometry();
        buffer.setAttribute("position", new BufferAttribute(positions.subarray(start * 12, end * 12), 4, true));
        const material = new RawShaderMaterial({
            glslVersion: GLSL3,
            vertexShader: meshVertex,
            fragmentShader: meshFragment,
            side: DoubleSide,
            uniforms: {
                ...this.shared,
                pieceOfFace: { value: numbers(pieceOfFace.subarray(start, end), FACE_WIDTH) },
                faceNumbers: { value: numbers(faceNumbers.subarray(start, end), FACE_WIDTH) },
            },
        });
        const mesh = new Mesh(buffer, material);
        mesh.frustumCulled = false;
        mesh.matrixAutoUpdate = false;
        return mesh;
    }

    /** What lies outside of the box is not drawn. @param {{ min: number[], max: number[] } | null} box metres */
    setClip(box) {
        this.shared.clipMin.value.fromArray(box?.min ?? [-FAR, -FAR, -FAR]);
        this.shared.clipMax.value.fromArray(box?.max ?? [FAR, FAR, FAR]);
    }

    /**
     * What the next drawing draws: faces `from` to `to` of display order.
     *
     * @param {number} from
     * @param {number} to
     */
    setRange(from, to) {
        this.blocks.forEach((block, i) => {
            const start = i * BLOCK_FACES;
            const first = Math.max(from - start, 0);
            const last = Math.min(to - start, BLOCK_FACES);
            block.visible = last > first;
            if (block.visible) block.geometry.setDrawRange(first * 3, (last - first) * 3);
        });
    }

    /**
     * Moves faces to other pieces.
     *
     * @param {ArrayLike<number>} faces scene face numbers
     * @param {ArrayLike<number>} pieces the new piece of each
     */
    movePieces(faces, pieces) {
        const touched = new Set();
        for (let i = 0; i < faces.length; i++) {
            const place = this.place(faces[i]);
            if (place === NOWHERE) continue;
            const block = Math.floor(place / BLOCK_FACES);
            this.geometry.pieceOfFace[place] = pieces[i];
            this.texture(block).image.data[place - block * BLOCK_FACES] = pieces[i];
            touched.add(block);
        }
        for (const block of touched) this.texture(block).needsUpdate = true;
    }

    /** @param {number} block @returns {any} */
    texture(block) {
        return this.blocks[block].material.uniforms.pieceOfFace.value;
    }

    /**
     * Where a face of the scene stands in display order; {@link NOWHERE} for one that is not here yet.
     *
     * @param {number} face scene face number
     */
    place(face) {
        if (!this.places) {
            const { faceNumbers, faces } = this.geometry;
            const most = faceNumbers.reduce((a, b) => Math.max(a, b), 0);
            this.places = new Uint32Array(most + 1).fill(NOWHERE);
            for (let i = 0; i < faces; i++) this.places[faceNumbers[i]] = i;
        }
        return this.places[face] ?? NOWHERE;
    }

    dispose() {
        for (const block of this.blocks) {
            block.geometry.dispose();
            block.material.uniforms.pieceOfFace.value.dispose();
            block.material.uniforms.faceNumbers.value.dispose();
            block.material.dispose();
        }
    }
}
