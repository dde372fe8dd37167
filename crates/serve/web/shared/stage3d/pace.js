// How many faces are drawn while the camera moves: as many as the machine draws in time.

/** Wanted time of a frame, milliseconds: 40 frames a second, with time left for the rest of the page. */
const GOAL_MS = 25;
/** The same for drawing without graphics hardware, where fewer faces would not make frames much shorter. */
const SOFTWARE_GOAL_MS = 60;
/** Minimum number of faces; with fewer, a scene is not recognisable. */
const MIN_FACES = 10_000;

/**
 * Follows the time between frames: fewer faces when they are late, more when they are early.
 *
 * A fixed budget, where the user has set one, is taken as it is.
 */
export class Pace {
    /** @param {number} faces all faces of the scene @param {boolean} software true when the processor draws */
    constructor(faces, software) {
        this.all = faces;
        /** @type {number | null} faces that the user wants while moving; null adapts */
        this.fixed = null;
        this.adapted = Math.min(faces, 300_000);
        this.goal = software ? SOFTWARE_GOAL_MS : GOAL_MS;
        this.smoothed = this.goal;
    }

    /** Faces to draw in the next frame of a motion. */
    get budget() {
        return Math.min(this.all, Math.round(this.fixed ?? this.adapted));
    }

    /**
     * Learns from a frame of a motion.
     *
     * @param {number} ms time since the frame before
     */
    frameTook(ms) {
        this.smoothed += 0.3 * (ms - this.smoothed);
        if (this.smoothed > this.goal * 1.3 && ms > this.goal) this.adapted = Math.max(Math.min(MIN_FACES, this.all), this.adapted * Math.max(0.5, this.goal / this.smoothed));
        else if (this.smoothed < this.goal) this.adapted = Math.min(this.all, this.adapted * 1.1);
    }
}
