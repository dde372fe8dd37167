// Things as they look: in the colours of their materials, and under the rendered picture of the planned frame that shows best what is looked at.

import { Vector3 } from "../vendor/three.js";
import { getBytes } from "../shared/api.js";
import { toastError } from "../shared/toast.js";

/** What a picture loses for each doubling of the distance between its camera and what is looked at; its direction counts up to 1. */
const DISTANCE = 0.15;
/** Pictures that are kept. */
const KEPT = 6;

export class RealLook {
    /** @param {import("./state.js").State} state @param {import("../shared/stage3d/stage.js").Stage3d} stage @param {import("./looking.js").Looking} looking */
    constructor(state, stage, looking) {
        this.state = state;
        this.stage = stage;
        this.frames = looking.frames.filter((/** @type {any} */ frame) => frame.photograph);
        this.on = false;
        /** Address of the picture that is shown or on its way. */
        this.shown = "";
        /** @type {Map<string, HTMLImageElement>} */
        this.images = new Map();
        this.hasColors = false;
        stage.addEventListener("settled", () => void this.#choose());
    }

    /** There is something to show. */
    get isKnown() {
        return this.state.scene.has_face_colors || this.frames.length > 0;
    }

    async toggle() {
        if (!this.isKnown) return;
        this.on = !this.on;
        this.stage.setReal(this.on);
        this.state.tell("view");
        if (!this.on) return;
        try {
            if (!this.hasColors && this.state.scene.has_face_colors) {
                this.stage.setFaceColors(new Uint8Array(await getBytes("/api/annotate/face_colors")));
                this.hasColors = true;
            }
        } catch (error) {
            toastError(error);
        }
        await this.#choose();
    }

    /** To be called when the scene has got more faces: what the picture shows is measured anew. */
    again() {
        this.shown = "";
        void this.#choose();
    }

    /** Shows the picture that suits the view. */
    async #choose() {
        const frame = this.on ? this.#best() : null;
        if (!frame) return;
        const address = `/api/annotate/photograph/${encodeURIComponent(frame.camera)}/${frame.frame}`;
        if (address === this.shown) return;
        this.shown = address;
        try {
            const image = await this.#image(address);
            if (address === this.shown) this.stage.setPhotograph(image, frame);
        } catch {
            // A picture that cannot be read is left out, and asked for again when the view has moved.
            if (address === this.shown) this.shown = "";
        }
    }

    /** @param {string} address */
    async #image(address) {
        const image = this.images.get(address) ?? Object.assign(new Image(), { src: address });
        await image.decode();
        this.images.set(address, image);
        if (this.images.size > KEPT) this.images.delete([...this.images.keys()][0]);
        return image;
    }

    /** The frame whose camera sees what the view's middle shows from the most alike direction and distance; null where none sees it. */
    #best() {
        const { element, camera } = this.stage;
        const point = this.stage.pointAt(element.clientWidth / 2, element.clientHeight / 2) ?? this.stage.controls.lookAt;
        const own = point.clone().sub(camera.position);
        const worth = (/** @type {any} */ frame) => {
            const m = frame.orientation;
            const way = point.clone().sub(new Vector3(...frame.position));
            const [x, y, z] = [0, 1, 2].map((axis) => way.x * m[axis] + way.y * m[3 + axis] + way.z * m[6 + axis]);
            const half = Math.tan((frame.fov_y_deg * Math.PI) / 360);
            if (z >= 0 || Math.abs(y / z) > half || Math.abs(x / z) > half * frame.aspect) return -Infinity;
            return way.clone().normalize().dot(own.clone().normalize()) - DISTANCE * Math.abs(Math.log2(way.length() / Math.max(own.length(), 1e-3)));
        };
        const worths = this.frames.map(worth);
        const most = Math.max(...worths);
        return Number.isFinite(most) ? this.frames[worths.indexOf(most)] : null;
    }
}
