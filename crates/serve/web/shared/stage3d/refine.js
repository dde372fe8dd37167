// Drawing all faces at rest, a portion at a time, so that neither the page nor the graphics processor is blocked.

/** Wanted time of a portion, milliseconds. */
const GOAL_MS = 50;
/** Faces of the first portion, before anything is known. */
const FIRST = 250_000;

/** Draws all faces into a target over several frames. Each portion waits until the one before is done. */
export class Refinement {
    /**
     * @param {import("../../vendor/three.js").WebGLRenderer} renderer
     * @param {import("./picture.js").SeenTarget} seen
     */
    constructor(renderer, seen) {
        this.renderer = renderer;
        this.gl = /** @type {WebGL2RenderingContext} */ (renderer.getContext());
        this.seen = seen;
        this.portion = FIRST;
        this.drawn = 0;
        this.started = 0;
        this.issued = 0;
        /** How long the last whole refinement took, milliseconds. */
        this.tookMs = 0;
        /** @type {WebGLSync | null} */
        this.fence = null;
    }

    /** Begins anew: something has changed. */
    restart() {
        this.drawn = 0;
        this.seen.complete = false;
        if (this.fence) this.gl.deleteSync(this.fence);
        this.fence = null;
    }

    /**
     * One portion, if the one before is done. True when all faces are drawn.
     *
     * @param {import("./mesh.js").SceneMesh} mesh
     * @param {import("../../vendor/three.js").PerspectiveCamera} camera
     * @param {number} width pixels of the picture
     * @param {number} height
     */
    advance(mesh, camera, width, height) {
        const now = performance.now();
        if (this.fence) {
            const state = this.gl.clientWaitSync(this.fence, 0, 0);
            if (state === this.gl.TIMEOUT_EXPIRED) return false;
            this.gl.deleteSync(this.fence);
            this.fence = null;
            const ratio = GOAL_MS / Math.max(now - this.issued, 1);
            this.portion = Math.round(this.portion * Math.min(2, Math.max(0.5, ratio)));
            if (this.drawn >= mesh.geometry.faces) {
                this.seen.complete = true;
                this.tookMs = now - this.started;
                return true;
            }
        }
        const target = this.seen.sized(width, height);
        this.renderer.setRenderTarget(target);
        if (this.drawn === 0) {
            this.started = now;
            this.renderer.clear();
        }
        const end = Math.min(mesh.geometry.faces, this.drawn + this.portion);
        mesh.setRange(this.drawn, end);
        this.renderer.render(mesh.scene, camera);
        this.renderer.setRenderTarget(null);
        this.drawn = end;
        this.issued = performance.now();
        this.fence = this.gl.fenceSync(this.gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
        this.gl.flush();
        return false;
    }
}
