// The open dataset, the scene and camera that are shown, and the layers that are needed for it.

import { toast, toastError } from "../shared/toast.js";
import { areasIn } from "./areas.js";
import { forget, getCamera, getDataset, getScene } from "./catalogue.js";
import { differenceOf, isAlike } from "./difference.js";
import { Loader } from "./loader.js";
import { Looks } from "./looks.js";
import { pixelOf } from "./numbers.js";
import { Tracks } from "./tracks.js";

/** @typedef {import("./catalogue.js").Dataset} Dataset */
/** @typedef {import("./catalogue.js").Scene} Scene */
/** @typedef {import("./catalogue.js").Camera} Camera */
/** @typedef {import("./numbers.js").LayerData} LayerData */
/** @typedef {{ camera: Camera, frame: number, layer: string, data: LayerData | undefined }} Side what one of two pictures shows */
/** @typedef {{ x: number, y: number, side: number }} Pixel under the cursor; side 0 is the left picture */

/** Layers that give names to a pixel, in the order in which they are told. */
export const NAMING = ["render_entity_id", "semantic", "semantic_instance", "material_id"];
/** The layer that says where the surface of a pixel is. */
export const PLACES = "position";
/** Frames that are fetched ahead in the direction of travel, and behind. */
const AHEAD = 5, BEHIND = 1;

/** Modes that show two pictures. */
export const TWO = ["side", "wipe", "difference"];

export class Session {
    /**
     * @param {Dataset} dataset
     * @param {import("./state.js").Store} store
     */
    constructor(dataset, store) {
        this.dataset = dataset;
        this.store = store;
        this.looks = new Looks(dataset);
        /** @type {Scene | null} */
        this.scene = null;
        /** @type {Camera | null} */
        this.camera = null;
        /** The camera of the other picture, where that is another. @type {Camera | null} */
        this.otherCamera = null;
        /** @type {{ message: string, help: string } | null} */
        this.problem = null;
        this.direction = 1;
        this.hoveredInstance = 0;
        /** True while frames go by: the layers that give names to pixels are fetched when they stop. */
        this.travelling = false;
        /** @type {() => void} */
        this.changed = () => {};
        /** @type {() => void} */
        this.entered = () => {};
        this.tracks = new Tracks(this);
        this.loader = new Loader(() => this.changed());
    }

    /** The instance that stands out: the one under the cursor, else the one that was clicked. */
    get marked() {
        return this.hoveredInstance || this.store.state.instance;
    }

    /** Opens the scene and camera of the state, or the first that exist. */
    async follow() {
        const { state } = this.store;
        try {
            const scenes = this.dataset.scenes;
            if (!scenes.length) throw { message: "The dataset has no scenes.", help: "Render some; they appear here as they come." };
            if (state.scene && !scenes.includes(state.scene)) throw missing(`scene ${state.scene}`, "this dataset", scenes);
            const scene = await getScene(state.scene || scenes[0]);
            if (state.camera && scene.cameras.length && !scene.cameras.includes(state.camera)) throw missing(`camera ${state.camera}`, `the scene ${scene.name}`, scene.cameras);
            const name = state.camera || scene.cameras[0];
            const camera = name === undefined ? null : await getCamera(scene.name, name);
            if (this.store.state.scene !== state.scene || this.store.state.camera !== state.camera) return;
            this.scene = scene;
            this.camera = camera;
            await this.followOther();
            const lost = scene.problems.find((one) => one.panel === "views");
            this.problem = camera ? null : lost ? { message: lost.error, help: lost.help } : { message: `The scene ${scene.name} has no cameras.`, help: "They appear here as they are planned; or choose another scene." };
            this.looks.enter(scene, [camera, this.otherCamera]);
            const near = this.#nearest(state);
            if (state.frame >= 0 && near.frame !== state.frame) toast(`Frame ${state.frame} has no pictures; this is frame ${near.frame}.`);
            this.store.set({ scene: scene.name, camera: name ?? "", ...near }, { step: false });
        } catch (error) {
            const { message, help } = /** @type {any} */ (error);
            this.problem = { message, help: help ?? "" };
            [this.scene, this.camera] = [null, null];
        }
        this.entered();
        this.refresh();
    }

    /** Opens the camera of the other picture, where that is not the one that is open. */
    async followOther() {
        const { scene, otherCamera } = this.store.state;
        if (!otherCamera) return void (this.otherCamera = null);
        try {
            const camera = await getCamera(this.scene?.name || scene, otherCamera);
            if (this.store.state.otherCamera !== otherCamera) return;
            this.otherCamera = camera;
            if (this.scene) this.looks.enter(this.scene, [this.camera, camera]);
        } catch (error) {
            toastError(error);
            this.store.set({ otherCamera: "", otherFrame: null }, { step: false });
        }
    }

    /** The other picture is of another frame. */
    get isOtherFrame() {
        const { frame, otherFrame, otherCamera } = this.store.state;
        return otherCamera !== "" || (otherFrame !== null && otherFrame !== frame);
    }

    /** Reads everything anew. */
    async reload() {
        this.loader.forget();
        this.tracks.forget();
        await this.reread();
    }

    /** Reads anew what there is, and keeps the pictures that are here. */
    async reread() {
        forget();
        this.dataset = await getDataset();
        await this.follow();
    }

    /**
     * The frame nearest to the one asked for that has pictures, and layers that exist there.
     * @param {import("./state.js").State} state
     */
    #nearest(state) {
        const frames = this.frames();
        if (!frames.length) return { frame: state.frame };
        const far = (/** @type {number} */ frame) => Math.abs(frame - state.frame);
        const frame = frames.reduce((best, one) => (far(one) < far(best) ? one : best), frames[0]);
        const there = this.layersOf(frame);
        const known = (/** @type {string} */ layer, /** @type {string} */ instead) => (there.includes(layer) ? layer : there.includes(instead) ? instead : (there[0] ?? layer));
        const layer = known(state.layer, "color");
        const other = known(state.other, "depth_meters");
        return { frame, layer, other: other === layer && state.otherFrame === null ? (there.find((one) => one !== layer) ?? other) : other };
    }

    /** The numbers of the frames that have pictures. */
    frames() {
        return (this.camera?.frames ?? []).filter((frame) => frame.layers.length).map(({ frame }) => frame);
    }

    /** The names of a frame's layers, and of what was derived from it. @param {number} frame @param {Camera | null} [camera] */
    layersOf(frame, camera = this.camera) {
        const entry = camera?.frames.find((one) => one.frame === frame);
        if (!camera || !entry) return [];
        return [...entry.layers.map((at) => this.dataset.layers[at].name), ...entry.derived.map((at) => camera.derived[at].name)];
    }

    /** @param {number} frame @param {string} layer @param {Camera | null} [camera] */
    #place(frame, layer, camera = this.camera) {
        return { scene: this.scene?.name ?? "", camera: camera?.name ?? "", frame, layer };
    }

    /** @param {number} frame @param {string} layer @param {Camera | null} [camera] */
    layer(frame, layer, camera = this.camera) {
        return this.loader.get(this.#place(frame, layer, camera));
    }

    /** Why what a side is to show cannot be had. @param {Side} side */
    failureOf({ camera, frame, layer }) {
        if (!this.layersOf(frame, camera).includes(layer)) return { error: `Frame ${frame} has no ${this.looks.title(layer)}.`, help: "" };
        return this.loader.failure(this.#place(frame, layer, camera));
    }

    /** What the pictures show, left first. @returns {Side[]} */
    sides() {
        const { frame, layer, other, otherFrame, otherCamera, mode } = this.store.state;
        if (!this.camera) return [];
        const first = { camera: this.camera, frame, layer, data: this.layer(frame, layer) };
        const camera = otherCamera ? this.otherCamera : this.camera;
        // The other camera may be on its way.
        if (!TWO.includes(mode) || !camera) return [first];
        const second = otherFrame ?? frame;
        return [first, { camera, frame: second, layer: other, data: this.layer(second, other, camera) }];
    }

    /** The first picture minus the second; null where that is not to be shown, or not possible yet. */
    difference() {
        const [first, second] = this.sides();
        if (this.store.state.mode !== "difference" || !first?.data || !second?.data || !this.#alike(first.layer, second.layer)) return null;
        return differenceOf(first.data, second.data);
    }

    /** @param {string} a @param {string} b */
    #alike(a, b) {
        return isAlike(this.looks.spec(a), this.looks.spec(b));
    }

    /** The layers that the other picture can have. @param {boolean} alike only those that can be subtracted from that of the first */
    othersOf(alike) {
        const { frame, otherFrame, otherCamera, layer } = this.store.state;
        const there = this.layersOf(otherFrame ?? frame, otherCamera ? this.otherCamera : this.camera);
        return alike ? there.filter((name) => this.#alike(name, layer)) : there;
    }

    /** Why there is no difference of the two pictures; null where there is one or none is asked for. */
    get noDifference() {
        const [first, second] = this.sides();
        if (this.store.state.mode !== "difference" || !second) return null;
        const words = (/** @type {string} */ layer) => `${this.looks.title(layer)} has ${this.looks.spec(layer).channels} per pixel${this.looks.spec(layer).unit ? ` in ${this.looks.spec(layer).unit}` : ""}`;
        if (!this.#alike(first.layer, second.layer)) return { error: "These layers hold different numbers.", help: `${words(first.layer)}, ${words(second.layer)}. Choose two of the same kind, or two frames.` };
        const whole = first.data?.step === 1 && second.data?.step === 1;
        return whole && !this.difference() ? { error: "The two pictures have different sizes.", help: `${first.data?.size[1]} × ${first.data?.size[0]} and ${second.data?.size[1]} × ${second.data?.size[0]} pixels.` } : null;
    }

    /** Everything that is shown is here in full. */
    get complete() {
        return this.sides().every((side) => side.data?.step === 1 || this.failureOf(side));
    }

    /** Tells the loader what is wanted: what is shown, what comes next, and what gives names to pixels. */
    refresh() {
        const { frame, otherFrame, mode } = this.store.state;
        if (mode === "gallery") {
            this.loader.want([]);
            return this.changed();
        }
        const sides = this.sides();
        const frames = this.frames();
        const at = frames.indexOf(frame);
        const near = [...Array(AHEAD).keys()].map((i) => (i + 1) * this.direction).concat([...Array(BEHIND).keys()].map((i) => -(i + 1) * this.direction));
        const neighbours = near.map((step) => frames[at + step]).filter((one) => one !== undefined);
        const moving = sides.filter((_, i) => i === 0 || otherFrame === null);
        const ahead = (/** @type {number[]} */ frames) => frames.flatMap((one) => moving.filter((side) => this.layersOf(one).includes(side.layer)).map((side) => this.#place(one, side.layer)));
        const named = (/** @type {string[]} */ layers) => NAMING.filter((layer) => !this.travelling && layers.includes(layer));
        const shown = sides.filter((side) => this.layersOf(side.frame, side.camera).includes(side.layer));
        this.loader.want([
            ...shown.map((side) => this.#place(side.frame, side.layer, side.camera)),
            ...ahead(neighbours.slice(0, 2)),
            ...named(this.layersOf(frame)).map((layer) => this.#place(frame, layer)),
            ...(this.store.state.ruler && this.layersOf(frame).includes(PLACES) ? [this.#place(frame, PLACES)] : []),
            ...ahead(neighbours.slice(2)),
        ], shown.length);
        this.changed();
    }

    /** Goes so many frames on, and stays within the trajectory. @param {number} steps */
    step(steps) {
        const frames = this.frames();
        const at = frames.indexOf(this.store.state.frame);
        const next = frames[Math.min(frames.length - 1, Math.max(0, at + steps))];
        this.direction = Math.sign(steps) || 1;
        if (next !== undefined) this.store.set({ frame: next }, { step: false });
    }

    /** The instances of a frame's pixels. @param {number} frame @param {Camera | null} [camera] */
    idsOf(frame, camera = this.camera) {
        return this.layer(frame, "semantic_instance", camera);
    }

    /** The picture has the pixels of the frame, which a lidar's has not. @param {Side} side */
    hasPixelsOfFrame({ camera: { projection }, data }) {
        return !projection || !data || (data.size[0] === projection.height && data.size[1] === projection.width);
    }

    /** A layer that names the pixels of what a side shows: of the same frame, and of the same pixels. @param {Side} side @param {string} layer */
    namesOf({ camera, frame, data }, layer) {
        const names = this.layer(frame, layer, camera);
        return names?.step === 1 && data && names.size.every((length, i) => length === data.size[i]) ? names : null;
    }

    /** How many pixels a frame has of each number of a layer, and the box around them. @param {number} frame @param {string} layer @param {Camera | null} [camera] */
    areasOf(frame, layer, camera = this.camera) {
        return areasIn(this.layer(frame, layer, camera));
    }

    /** The box around the visible pixels of an instance. @param {number} frame @param {number} id @param {Camera} camera */
    boundsOf(frame, id, camera) {
        return this.areasOf(frame, "semantic_instance", camera)?.get(id)?.bounds ?? null;
    }

    /** The instances that a frame shows, the largest first. @param {number} frame @param {Camera} camera */
    instancesOf(frame, camera) {
        const areas = [...(this.areasOf(frame, "semantic_instance", camera) ?? [])].filter(([id]) => id > 0);
        return areas.sort((a, b) => b[1].pixels - a[1].pixels).map(([id]) => id);
    }

    /** @param {Pixel | null} pixel */
    #instanceAt(pixel) {
        const side = pixel && this.sides()[pixel.side];
        const ids = side && this.namesOf(side, "semantic_instance");
        return (ids && pixelOf(ids, pixel?.x ?? 0, pixel?.y ?? 0)?.[0]) || 0;
    }

    /** Marks the instance under the cursor. @param {Pixel | null} pixel */
    hover(pixel) {
        this.hoveredInstance = Math.max(0, this.#instanceAt(pixel));
    }

    /** Keeps the instance under the cursor marked, or lets go. @param {Pixel | null} pixel */
    pin(pixel) {
        const id = Math.max(0, this.#instanceAt(pixel));
        this.store.set({ instance: id === this.store.state.instance ? 0 : id });
    }
}

/** What is said of a link to something that is not there. @param {string} what @param {string} where @param {string[]} there */
const missing = (what, where, there) => ({ message: `There is no ${what} in ${where}.`, help: `It has ${there.slice(0, 8).join(", ")}${there.length > 8 ? ` and ${there.length - 8} more` : ""}.` });
