// Moving from frame to frame: while a key is held, every frame is shown, as fast as frames arrive.

export class Travel {
    /** @param {import("./session.js").Session} session */
    constructor(session) {
        this.session = session;
        this.direction = 0;
        this.playing = false;
        this.next = 0;
        /** Frames that were shown since the journey began, and when it began. */
        this.shown = 0;
        this.begin = 0;
        addEventListener("keyup", (event) => {
            if (event.key === "ArrowLeft" || event.key === "ArrowRight") this.stop();
        });
        addEventListener("blur", () => this.stop());
    }

    /** Goes on step by step until it is stopped. @param {number} direction @param {boolean} [play] at most 24 frames per second, round and round */
    go(direction, play = false) {
        const begins = !this.direction;
        this.direction = direction;
        this.playing = play;
        if (!begins) return;
        [this.shown, this.begin] = [0, performance.now()];
        this.next = 0;
        this.#step();
        // A single press is one step; holding begins when the key repeats.
        this.held = play;
        this.session.travelling = play;
        requestAnimationFrame((time) => this.#tick(time));
    }

    /** The key repeats: it is held. */
    hold() {
        this.held = true;
        this.session.travelling = true;
    }

    stop() {
        if (!this.direction) return;
        this.direction = 0;
        this.playing = false;
        this.held = false;
        this.session.travelling = false;
        this.session.refresh();
    }

    /** Frames per second since the journey began. */
    get rate() {
        return (1000 * this.shown) / Math.max(1, performance.now() - this.begin);
    }

    #step() {
        const { session } = this;
        const frames = session.frames();
        if (this.playing && frames.length > 1 && session.store.state.frame === frames.at(-1)) session.store.set({ frame: frames[0] });
        else session.step(this.direction);
    }

    /** @param {number} time */
    #tick(time) {
        if (!this.direction) return;
        if (this.held && this.session.complete && time >= this.next) {
            this.next = time + (this.playing ? 1000 / 24 - 4 : 0);
            this.shown++;
            this.#step();
        }
        requestAnimationFrame((next) => this.#tick(next));
    }
}
