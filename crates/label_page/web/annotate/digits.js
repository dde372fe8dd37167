// Digits that are typed for a class. They show while they are typed; any other key, a click or a pause ends the number. A number that is no
// class leaves no class to give, so that no label is given by mistake. After a pause, Backspace still means the number and takes all of it back.

/** The number that is being typed. */
export class Digits {
    /** @param {import("./state.js").State} state */
    constructor(state) {
        this.state = state;
        this.typed = "";
        /** True while a pause was the last thing that happened to a number. */
        this.paused = false;
        /** The class and layer before the number was begun. @type {Record<string, any>} */
        this.before = {};
        /** A pause of this length ends the number, milliseconds. */
        this.pauseMs = 900;
        this.timer = 0;
    }

    /** @param {string} digit */
    type(digit) {
        const { layer, currentClass, erase, refused } = this.state;
        if (this.typed === "") this.before = { layer, currentClass, erase, refused };
        this.show(this.typed + digit);
    }

    /** Takes the last digit back. */
    back() {
        this.show(this.typed.slice(0, -1));
    }

    /** Takes the number back: the class before it is the current one again. */
    discard() {
        this.show("");
    }

    /** The number is complete. */
    end() {
        this.paused = false;
        clearTimeout(this.timer);
        if (this.typed === "") return;
        this.typed = "";
        this.state.tell("typed");
    }

    /** Makes the class with this number the current one, or none where there is none. @param {string} typed */
    show(typed) {
        this.typed = typed;
        this.paused = false;
        clearTimeout(this.timer);
        if (typed === "") {
            this.state.set(this.before);
        } else {
            this.timer = setTimeout(() => {
                this.end();
                this.paused = true;
            }, this.pauseMs);
            this.state.setClass(Number(typed));
        }
        this.state.tell("typed");
    }

    /** What the number means so far. */
    get meaning() {
        const { classById, classes } = this.state;
        const one = classById.get(Number(this.typed));
        if (one) return one.name;
        return classes.some(({ id }) => String(id).startsWith(this.typed)) ? "…" : "no class has this number";
    }

    /**
     * Takes a key. True when nothing else is to be done with it.
     *
     * @param {string} name as in the table of commands
     */
    key(name) {
        if (/^\d$/.test(name)) {
            this.type(name);
            return true;
        }
        if ((this.typed !== "" || this.paused) && (name === "Backspace" || name === "Escape")) {
            if (name === "Backspace" && !this.paused) this.back();
            else this.discard();
            return true;
        }
        this.end();
        return false;
    }
}
