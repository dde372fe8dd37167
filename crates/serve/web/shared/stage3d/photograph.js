// A photograph of the scene: its camera, and how far it sees at each of its pixels, so that it is laid over what it shows and nothing else.

import { Matrix4, PerspectiveCamera, Texture, Vector3 } from "../../vendor/three.js";
import { rotation } from "./camera.js";
import { SeenTarget } from "./picture.js";
import { PIECE_WIDTH } from "./shaders.js";
import { numbers } from "./tables.js";

/** Width of the picture of distances, pixels. */
const WIDTH = 1024;
/** What is nearer to the camera is not in the photograph, metres. */
const NEAR_M = 0.02;

export class Photograph {
    constructor() {
        this.camera = new PerspectiveCamera();
        this.seen = new SeenTarget(1);
        this.fromWorld = new Matrix4();
        /** @type {Texture | null} */
        this.texture = null;
    }

    /**
     * Takes another photograph in the place of this one.
     *
     * @param {HTMLImageElement} image
     * @param {import("./camera.js").CameraJson & { aspect: number }} json
     * @param {import("../../vendor/three.js").WebGLRenderer} renderer
     * @param {import("./mesh.js").SceneMesh} mesh
     * @param {import("./tables.js").Tables} tables
     */
    take(image, json, renderer, mesh, tables) {
        const { camera } = this;
        camera.position.set(json.position[0], json.position[1], json.position[2]);
        camera.quaternion.copy(rotation(json.orientation));
        Object.assign(camera, { fov: json.fov_y_deg, aspect: json.aspect, near: NEAR_M, far: this.#farthest(mesh) });
        camera.updateProjectionMatrix();
        camera.updateMatrixWorld();
        this.fromWorld.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
        this.#measure(renderer, mesh, tables);
        this.texture?.dispose();
        this.texture = new Texture(image);
        this.texture.generateMipmaps = false;
        this.texture.minFilter = this.texture.magFilter;
        this.texture.needsUpdate = true;
    }

    /** Beyond all faces. @param {import("./mesh.js").SceneMesh} mesh */
    #farthest({ geometry: { min, max } }) {
        const [a, b] = [new Vector3(...min), new Vector3(...max)];
        return Math.max(1, a.distanceTo(b) + a.add(b).multiplyScalar(0.5).distanceTo(this.camera.position));
    }

    /** Draws the distances of all faces, also of what is hidden or clipped in the view: it is in the photograph. @param {import("../../vendor/three.js").WebGLRenderer} renderer @param {import("./mesh.js").SceneMesh} mesh @param {import("./tables.js").Tables} tables */
    #measure(renderer, mesh, tables) {
        const { pieceFlags, clipMin, clipMax } = mesh.shared;
        const [flags, min, max] = [pieceFlags.value, clipMin.value.toArray(), clipMax.value.toArray()];
        pieceFlags.value = numbers(new Uint8Array(tables.flags.length), PIECE_WIDTH);
        mesh.setClip(null);
        renderer.setRenderTarget(this.seen.sized(WIDTH, Math.max(1, Math.round(WIDTH / this.camera.aspect))));
        renderer.clear();
        mesh.setRange(0, mesh.geometry.faces);
        renderer.render(mesh.scene, this.camera);
        renderer.setRenderTarget(null);
        pieceFlags.value.dispose();
        pieceFlags.value = flags;
        mesh.setClip({ min, max });
    }

    dispose() {
        this.texture?.dispose();
        this.texture = null;
        this.seen.dispose();
    }
}
