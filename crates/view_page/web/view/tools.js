// Tools that keys use on a picture: values pixel by pixel, distances, one point that is followed; and what screen readers are told of them.

import { byId } from "../shared/dom.js";
import { say } from "../shared/say.js";
import { toast } from "../shared/toast.js";
import { faultText } from "./records.js";
import { rulerWords, withEnd } from "./ruler.js";
import { factsOf, nextTrack } from "./tracks.js";

/** What is shown is told when it has not changed for this long, milliseconds. */
const TELL_MS = 350;

export class Tools {
    /** @param {import("./session.js").Session} session @param {import("./stage.js").Stage} stage */
    constructor(session, stage) {
        this.session = session;
        this.stage = stage;
        this.telling = 0;
    }

    /** Keeps the point that is followed alone in the middle of a picture that is enlarged. */
    followTrack() {
        const { track, frame, zoom } = this.session.store.state;
        const followed = track > 0 && zoom > 0 && this.session.camera ? this.session.tracks.of(this.session.camera) : null;
        const place = followed && factsOf(followed, track, frame).place;
        if (place) this.session.store.set({ x: place[0], y: place[1] }, { step: false });
    }

    /** Follows the next point of the frame alone. */
    nextTrack() {
        const { camera, tracks } = this.session;
        const followed = camera ? tracks.of(camera) : null;
        const { frame, track } = this.session.store.state;
        this.session.store.set({ tracks: true, track: followed ? nextTrack(followed, frame, track) : 0 });
    }

    /** Puts an end of the ruler at the pixel under the cursor. */
    measure() {
        const { pixel } = this.stage;
        if (!pixel || pixel.side > 0) return toast("Point at the picture to measure.", "With the mouse, or Ctrl and the arrows.");
        this.session.store.set({ ruler: withEnd(this.session.store.state.ruler, pixel), tab: "display" });
        this.session.refresh();
        this.#tellSoon(() => (this.session.store.state.ruler ? rulerWords(this.session) : "No distance is measured."));
    }

    /** Moves the pixel whose values are read, and tells them. @param {number} dx @param {number} dy */
    readPixel(dx, dy) {
        this.stage.movePixel(dx, dy);
        this.#tellSoon(() => [...byId("readout").children].map((line) => line.textContent?.replace(/\s+/gu, " ").trim()).filter(Boolean).join("; "));
    }

    /** Tells screen readers which frame and layer is shown. */
    tell() {
        this.#tellSoon(() => {
            const { mode, frame, layer } = this.session.store.state;
            const frames = this.session.frames();
            if (mode === "gallery" || !frames.length) return "";
            const faults = this.session.camera?.frames.find((one) => one.frame === frame)?.faults ?? [];
            return [`Frame ${frame}, ${frames.indexOf(frame) + 1} of ${frames.length}`, mode === "space" ? "3D" : this.session.looks.title(layer), ...faults.map(faultText)].join(", ");
        });
    }

    /** Tells something when nothing new has come for a while. @param {() => string} words */
    #tellSoon(words) {
        clearTimeout(this.telling);
        this.telling = setTimeout(() => say(words()), TELL_MS);
    }
}
