// Follows a dataset that is being made: asks now and then whether the server has something new, and reads it.

import { forget, peek } from "./catalogue.js";

/** Between two questions: at first and while frames are missing, and when all are there. */
const SOON_MS = 4000, LATER_MS = 30_000;

export class Watch {
    /** @param {import("./session.js").Session} session @param {(newFrames: number) => Promise<void>} changed */
    constructor(session, changed) {
        this.session = session;
        this.changed = changed;
        /** What the server said last, and of which camera. */
        this.last = "";
        this.#later();
        document.addEventListener("visibilitychange", () => document.hidden || this.#look());
    }

    /** Frames of the camera that are planned and not rendered yet. */
    get missing() {
        return (this.session.camera?.frames ?? []).filter(({ layers, faults }) => !layers.length && !faults.length).length;
    }

    #later() {
        clearTimeout(this.timer);
        this.timer = setTimeout(() => this.#look(), this.missing || !this.last ? SOON_MS : LATER_MS);
    }

    async #look() {
        const { scene, camera } = this.session;
        if (document.hidden || !scene || !camera) return this.#later();
        try {
            // The browser sends the tag of what it has, and the server answers with nothing where that is still true.
            const said = await peek(scene.name, camera.name);
            const key = `${scene.name}/${camera.name} ${said}`;
            const isNew = this.last.startsWith(`${scene.name}/${camera.name} `) && this.last !== key;
            this.last = key;
            if (isNew) {
                const before = this.session.frames().length;
                forget();
                await this.session.follow();
                await this.changed(this.session.frames().length - before);
            }
        } catch {
            // The server has ended; whoever asks for something is told so.
        }
        this.#later();
    }
}
