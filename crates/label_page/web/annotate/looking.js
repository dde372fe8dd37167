// Where the camera goes, and what it sees: planned cameras, pieces, the whole scene, what is hidden.

import { Vector3 } from "../vendor/three.js";
import { postJson } from "../shared/api.js";
import { byId } from "../shared/dom.js";
import { toast, toastError } from "../shared/toast.js";
import { ceilings } from "./ceilings.js";
import { extentToShow } from "./extent.js";
import { rooms } from "./rooms.js";

/** The direction from the scene to the camera that shows all of it, beside the camera's own turn: so far down, degrees. */
const DOWN_DEG = 40;

/** The same for a room: the sight of it from nearly above. */
const ROOM_DOWN_DEG = 62;
/** A step of a side of the clip box, metres. */
export const CLIP_STEP_M = 0.25;
/** So much is left around what the clip box is put around, metres. */
const CLIP_ROOM_M = 0.3;

/** What the commands of the camera and of visibility do. */
export class Looking {
    /** @param {import("./state.js").State} state @param {import("../shared/stage3d/stage.js").Stage3d} stage */
    constructor(state, stage) {
        this.state = state;
        this.stage = stage;
        this.wireframe = false;
        this.outlines = true;
        this.camera = -1;
        /** Ceilings that are hidden by command. @type {number[] | null} */
        this.ceilings = null;
        this.rooms = rooms(state);
        /** The room that is shown alone; -1 for none. */
        this.room = -1;
        /** True while ceilings are hidden because a room is shown. */
        this.openedRoom = false;
        /** What was hidden before a selection was isolated. @type {Set<number>} */
        this.hiddenBefore = new Set();
        /** Counts flights to pieces, so that a late answer does not end a newer one. */
        this.flights = 0;
        /** All planned frames, in order. */
        this.frames = state.scene.cameras.flatMap((/** @type {any} */ camera) => camera.frames.map((/** @type {any} */ frame) => ({ ...frame, camera: camera.name })));
    }

    /** Selects a piece and looks at it. @param {number} piece @param {{ camera: string, frame: number } | null} [view] */
    goToPiece(piece, view = null) {
        this.state.select([piece]);
        const frame = view && this.frames.find((/** @type {any} */ one) => one.camera === view.camera && one.frame === view.frame);
        if (frame) this.goToFrame(this.frames.indexOf(frame));
        else void this.lookAt([piece]);
    }

    /** Goes where these pieces are seen freely. @param {number[]} pieces */
    async lookAt(pieces) {
        const flight = ++this.flights;
        try {
            const place = await postJson("/api/annotate/viewpoint", { camera: this.stage.cameraJson(), pieces, hidden: this.state.unseen });
            if (place && flight === this.flights) this.stage.flyTo(new Vector3(...place.from), new Vector3(...place.to));
        } catch (error) {
            toastError(error);
        }
    }

    /** @param {number} index */
    goToFrame(index) {
        const frame = this.frames[index];
        if (!frame) return;
        this.flights++;
        this.camera = index;
        // In the box of another room it would see nothing.
        const { clip } = this.stage;
        if (clip && frame.position.some((/** @type {number} */ v, /** @type {number} */ axis) => v < clip.min[axis] || v > clip.max[axis])) this.goToRoom(-1);
        byId("cameras").value = String(index);
        history.replaceState(null, "", `#camera=${encodeURIComponent(frame.camera)}:${frame.frame}`);
        this.stage.goTo(frame);
    }

    /** @param {number} by */
    stepCamera(by) {
        if (this.frames.length > 0) this.goToFrame((this.camera + by + this.frames.length) % this.frames.length);
    }

    /** Shows all of the scene, obliquely from where the camera is turned to. */
    wholeScene() {
        this.show(this.#back(DOWN_DEG));
    }

    /** The direction to a camera that is turned as this one and looks so far down. @param {number} degrees */
    #back(degrees) {
        const back = new Vector3(0, 0, 1).applyQuaternion(this.stage.camera.quaternion);
        const turn = Math.hypot(back.x, back.y) > 1e-3 ? Math.atan2(back.y, back.x) : -Math.PI / 2;
        const down = (degrees * Math.PI) / 180;
        return new Vector3(Math.cos(turn) * Math.cos(down), Math.sin(turn) * Math.cos(down), Math.sin(down));
    }

    /** Shows all of the scene from straight above, without ceilings. */
    fromAbove() {
        if (!this.ceilings) this.toggleCeilings();
        this.show(new Vector3(0, 0, 1));
    }

    /** @param {Vector3} back from the scene to the camera */
    show(back) {
        const { min, max } = extentToShow(this.state);
        this.flights++;
        this.stage.frameBox(min, max, back);
    }

    /** Hides what covers rooms from above, or shows it again. */
    toggleCeilings() {
        const { state } = this;
        const hidden = new Set(state.hidden);
        if (this.ceilings) {
            for (const piece of this.ceilings) hidden.delete(piece);
            this.ceilings = null;
        } else {
            const found = ceilings(state);
            if (found.length === 0) return toast("Nothing here is known as a ceiling.", "Label it as one, or hide it with H.");
            this.ceilings = found;
            for (const piece of found) hidden.add(piece);
        }
        this.openedRoom = false;
        state.setVisibility(hidden, state.xray, state.isolated);
    }

    /** Shows only what lies in a box; null shows all of the scene. @param {{ min: number[], max: number[] } | null} box metres */
    clip(box) {
        this.room = -1;
        this.stage.setClip(box);
        this.state.tell("view");
    }

    /** Puts the clip box around these pieces. @param {number[]} pieces */
    clipTo(pieces) {
        const { mins, maxs } = this.state.pieces;
        const end = (/** @type {number[][]} */ ends, /** @type {number} */ sign) => [0, 1, 2].map((axis) => sign * Math.max(...pieces.map((piece) => sign * ends[piece][axis])) + sign * CLIP_ROOM_M);
        this.clip({ min: end(mins, -1), max: end(maxs, 1) });
    }

    /** Moves the upper side of the clip box. @param {number} by metres, upward */
    moveTop(by) {
        this.#moveSide(2, 1, by);
    }

    /** Moves the side of the clip box that faces the camera. @param {number} by metres, outward */
    moveNearSide(by) {
        const back = new Vector3(0, 0, 1).applyQuaternion(this.stage.camera.quaternion).toArray();
        const axis = Math.abs(back[0]) > Math.abs(back[1]) ? 0 : 1;
        this.#moveSide(axis, Math.sign(back[axis]) || 1, by);
    }

    /** Moves a side; beyond the scene it clips nothing, and a box that clips nothing is none. @param {number} axis @param {number} sign of the side @param {number} by metres, outward */
    #moveSide(axis, sign, by) {
        const { bounds } = this.state.scene;
        const box = { min: [...(this.stage.clip?.min ?? bounds.min)], max: [...(this.stage.clip?.max ?? bounds.max)] };
        if (sign > 0) box.max[axis] = Math.min(bounds.max[axis], Math.max(box.min[axis] + CLIP_STEP_M, box.max[axis] + by));
        else box.min[axis] = Math.max(bounds.min[axis], Math.min(box.max[axis] - CLIP_STEP_M, box.min[axis] - by));
        const isWhole = [0, 1, 2].every((i) => box.min[i] <= bounds.min[i] && box.max[i] >= bounds.max[i]);
        this.clip(isWhole ? null : box);
    }

    /** Shows a room alone, from above; -1 shows all of the scene. @param {number} index of the rooms */
    goToRoom(index) {
        const room = this.rooms[index];
        if (!room) {
            if (this.openedRoom) this.toggleCeilings();
            return this.clip(null);
        }
        this.clip(room);
        this.room = index;
        if (!this.ceilings && ceilings(this.state).length > 0) {
            this.toggleCeilings();
            this.openedRoom = true;
        }
        this.flights++;
        this.stage.frameBox(room.min, room.max, this.#back(ROOM_DOWN_DEG));
        this.state.tell("view");
    }

    showAll() {
        [this.ceilings, this.openedRoom] = [null, false];
        this.clip(null);
        this.state.setVisibility([], []);
    }

    /** @param {number[]} pieces */
    xray(pieces) {
        const { state } = this;
        const all = pieces.every((piece) => state.xray.has(piece));
        const xray = new Set(state.xray);
        for (const piece of pieces) all ? xray.delete(piece) : xray.add(piece);
        state.setVisibility(state.hidden, xray, state.isolated);
    }

    /** @param {number[]} pieces */
    isolate(pieces) {
        const { state } = this;
        if (state.isolated) return state.setVisibility(this.hiddenBefore, state.xray);
        this.hiddenBefore = state.hidden;
        const kept = new Set(pieces);
        state.setVisibility([...Array(state.count).keys()].filter((piece) => !kept.has(piece)), state.xray, true);
    }

    /** @param {number[]} pieces */
    hide(pieces) {
        const { state } = this;
        state.setVisibility([...state.hidden, ...pieces], state.xray, state.isolated);
        state.select([]);
    }

    toggleWireframe() {
        this.wireframe = !this.wireframe;
        this.stage.setWireframe(this.wireframe);
    }

    toggleOutlines() {
        this.outlines = !this.outlines;
        this.stage.setOutlines(this.outlines);
    }

    /** @param {number} factor */
    speed(factor) {
        const { controls } = this.stage;
        controls.speed = Math.min(20, Math.max(0.1, controls.speed * factor));
        this.state.tell("view");
    }
}
