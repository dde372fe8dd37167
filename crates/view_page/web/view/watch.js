// Follows a dataset that is being made: asks now and then whether the server has something new, and reads it.

import { forget, peek, peekDataset } from "./catalogue.js";

/** Between two questions: at first and while frames are missing, and when all are there. */
const SOON_MS = 4000, LATER_MS = 30_000;

export class Watch {
    /** @param {import("./session.js").Session} session @param {(newFrames: number) => Promise<void>} changed */
    constructor(session, changed) {
        this.session = session;
        this.changed = changed;
        /** What the server said last of the camera that is shown, and of which. */
        this.last = "";
        /** What it said last of the dataset: scenes, pages, the verdict. */
        this.whole = JSON.stringify(session.dataset);
        this.#later();
        document.addEventListener("visibilitychange", () => document.hidden || this.#look());
    }

    /** Frames of the camera that are planned and not rendered yet. */
    get missing() {
        return (this.session.camera?.frames ?? []).filter(({ layers, faults }) => !layers.length && !faults.length).length;
    }

    #later() {
        clearTimeout(this.timer);
        const soon = !this.session.camera || this.missing || !this.last;
        this.timer = setTimeout(() => this.#look(), soon ? SOON_MS : LATER_MS);
    }

    async #look() {
        if (document.hidden) return this.#later();
        try {
            if ((await this.#datasetIsNew()) || !this.session.camera || (await this.#cameraIsNew())) {
                const before = this.session.frames().length;
                await this.session.reread();
                await this.changed(this.session.frames().length - before);
            }
        } catch {
            // The server has ended; whoever asks for something is told so.
        }
        this.#later();
    }

    async #datasetIsNew() {
        const said = await peekDataset();
        const isNew = said !== this.whole;
        this.whole = said;
        return isNew;
    }

    async #cameraIsNew() {
        const { scene, camera } = this.session;
        if (!scene || !camera) return false;
        // The browser sends the tag of what it has, and the server answers with nothing where that is still true.
        const key = `${scene.name}/${camera.name} ${await peek(scene.name, camera.name)}`;
        const isNew = this.last.startsWith(`${scene.name}/${camera.name} `) && this.last !== key;
        this.last = key;
        return isNew;
    }
}
