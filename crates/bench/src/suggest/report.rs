//! The report on suggestions, as Markdown (`suggest.md`) and JSON (`suggest.json`).

use super::actions::Actions;
use super::measured::{FOLDS, Measured};
use super::others::Other;
use super::pairs::OfKind;
use super::scores::{By, Judgement};
use enfilade_scene::NYU40;
use enfilade_suggest::Suggester;
use enfilade_suggest::chain::Inner;
use enfilade_suggest::learn::{NameGroup, NamedObject, Split};
use std::fmt::Write;
use std::path::Path;

/// Bounds of confidence in the table of reliability.
const BOUNDS: [f64; 10] = [0.0, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 1.0001];

/// All that was measured.
pub struct Report<'a> {
    pub objects: &'a [NamedObject],
    pub groups: &'a [NameGroup],
    /// By split: with curtains read as NYU40 has them, and our suggestions judged by the labels as they are.
    pub measured: &'a [(Measured, Judgement)],
    /// Names of curtains that Hypersim labels as blinds.
    pub curtains: usize,
    /// Actions per scene with our suggestions and with those of the lookup.
    pub saved: &'a [Vec<Actions>; 2],
    /// Names of two, with volumes held out.
    pub of_two: &'a [OfKind],
    pub others: &'a [Other],
    /// Confidence from which on suggestions are sure.
    pub threshold: f32,
    pub suggester: &'a Suggester,
}

impl Report<'_> {
    /// Prints the report, and writes `suggest.md` and `suggest.json` to `folder`.
    pub fn write(&self, folder: &Path) -> Result<(), Box<dyn std::error::Error>> {
        let text = self.text()?;
        print!("{text}");
        let rows = serde_json::to_string_pretty(&self.rows())? + "\n";
        for (file, text) in [("suggest.md", text), ("suggest.json", rows)] {
            let path = folder.join(file);
            std::fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display()))?;
        }
        Ok(())
    }

    fn text(&self) -> Result<String, std::fmt::Error> {
        let mut text = String::from("# Suggestions: their quality on held-out scenes\n\n");
        let labelled = self.objects.iter().filter(|object| object.class > 0).count();
        let worded: usize = self.groups.iter().filter(|group| !group.words.is_empty()).map(NameGroup::labelled).sum();
        let ceiling = Judgement::ceiling(self.groups);
        writeln!(
            text,
            "Made by `cargo xtask bench suggest` from the {} object names of Hypersim's 482 scenes, {labelled} of them labelled. Names are judged by\n\
            models that saw nine tenths of the scenes, or of the volumes. The scenes of a volume were made and named by the same people, so the\n\
            second is what to expect for a scene by somebody else. *Names* are the different names of a scene, ignoring numbers, that have words and\n\
            labelled objects; {:.0} % of the labelled objects have names with words; the others are numbers like `AI41_005_0903`, which say\n\
            nothing. Having no suggestion counts as wrong.\n",
            self.objects.len(),
            100.0 * worded as f64 / labelled as f64,
        )?;
        self.accuracy(&mut text)?;
        writeln!(
            text,
            "\nFrom names alone, nobody can be right about more than {:.1} % of the {:.0} names that occur in several scenes. This is how often a name has\n\
            its most frequent class, since people label the same thing differently.\n\n\
            {} names of curtains that Hypersim labels as blinds count as curtains here, as NYUv2 has them. By Hypersim's own labels, {:.1} % of\n\
            names are right with scenes held out, {:.1} % with volumes.\n",
            100.0 * ceiling[1],
            ceiling[0],
            self.curtains,
            100.0 * self.measured[0].1.accuracy(By::Name, true),
            100.0 * self.measured[1].1.accuracy(By::Name, true),
        )?;
        self.reliability(&mut text)?;
        self.unlabelled(&mut text)?;
        self.actions(&mut text)?;
        self.names_around(&mut text)?;
        self.strangers(&mut text)?;
        self.classes(&mut text)?;
        Ok(text)
    }

    fn accuracy(&self, text: &mut String) -> std::fmt::Result {
        let (scene, volume) = (&self.measured[0].0, &self.measured[1].0);
        writeln!(
            text,
            "| % | scenes held out: ours | lookup of whole names | names of classes | volumes held out: ours | lookup of whole names |"
        )?;
        writeln!(text, "|---|---|---|---|---|---|")?;
        let mut row = |name: &str, of: &dyn Fn(&Judgement) -> f64| {
            let cells = [&scene.ours, &scene.lookup, &scene.keyword, &volume.ours, &volume.lookup].map(|j| format!("{:.1}", 100.0 * of(j)));
            writeln!(text, "| {name} | {} |", cells.join(" | "))
        };
        row("names, class right", &|j| j.accuracy(By::Name, true))?;
        row("objects whose names have words", &|j| j.accuracy(By::Object, true))?;
        row("all labelled objects", &|j| j.accuracy(By::Object, false))?;
        row("all labelled objects, mean over scenes", &Judgement::accuracy_per_scene)?;
        row("names covered at 95 % precision", &|j| j.coverage(0.95, By::Name)[0])?;
        row("names covered at 90 % precision", &|j| j.coverage(0.90, By::Name)[0])?;
        row("objects with words covered at 95 % precision", &|j| j.coverage(0.95, By::Object)[0])?;
        row("objects with words covered at 90 % precision", &|j| j.coverage(0.90, By::Object)[0])
    }

    fn reliability(&self, text: &mut String) -> std::fmt::Result {
        writeln!(text, "## Calibration of the confidence\n")?;
        writeln!(text, "Confidences come from a curve fitted to the folds other than the one that is judged, with volumes held out.\n")?;
        writeln!(
            text,
            "| confidence | names | mean confidence | right, % of names | objects | right, % of objects |\n|---|---|---|---|---|---|"
        )?;
        let judgement = &self.measured[1].0.ours;
        for (pair, bin) in BOUNDS.windows(2).zip(judgement.reliability(&BOUNDS)) {
            let [names, mean, right, objects, of_objects] = bin;
            let (low, high) = (pair[0], pair[1].min(1.0));
            writeln!(
                text,
                "| {low:.2} to {high:.2} | {names:.0} | {mean:.2} | {:.1} | {objects:.0} | {:.1} |",
                100.0 * right,
                100.0 * of_objects
            )?;
        }
        let errors = [0, 1].map(|i| 100.0 * self.measured[i].0.ours.calibration_error());
        writeln!(
            text,
            "\nExpected calibration error of names, in twenty bins: {:.1} % with scenes held out, {:.1} % with volumes.\n",
            errors[0], errors[1]
        )?;
        writeln!(
            text,
            "| wanted precision | least confidence | right, % of names | of the names, % | right, % of objects | of the objects with words, % |"
        )?;
        writeln!(text, "|---|---|---|---|---|---|")?;
        for precision in [0.8, 0.85, 0.9, 0.95] {
            let Some(min) = self.suggester.min_confidence(precision) else { continue };
            let [names, covered] = judgement.of_confidence(f64::from(min), By::Name).map(|x| 100.0 * x);
            let [objects, of_objects] = judgement.of_confidence(f64::from(min), By::Object).map(|x| 100.0 * x);
            writeln!(text, "| {:.0} % | {min} | {names:.1} | {covered:.1} | {objects:.1} | {of_objects:.1} |", 100.0 * precision)?;
        }
        Ok(())
    }

    /// The value of the names around a part.
    fn names_around(&self, text: &mut String) -> std::fmt::Result {
        writeln!(
            text,
            "\n## Names around a part\n\n\
            Hypersim's scenes have no hierarchy, so its two-word names replace one here: of `sofa leg`, *leg* counts as the name of a part in a\n\
            *sofa*. These are labelled names whose first half names a thing, with volumes held out. *Inner* is the part's own name alone, as glTF and\n\
            FBX were read before the names around a part counted; *joined* is both as one name, as USD was read; *both* is the current method.\n"
        )?;
        writeln!(
            text,
            "| the inner name is | names | inner, % right | joined, % right | both, % right | mean confidence | sure (90 %): names, right % |"
        )?;
        writeln!(text, "|---|---|---|---|---|---|---|")?;
        for row in self.of_two {
            let [inner, joined, both] = [row.inner, row.joined, row.both].map(|share| 100.0 * share);
            let (sure, right) = (row.sure.0, 100.0 * row.sure.1);
            let kind = match row.kind {
                None => "a thing: it is kept",
                Some(Inner::Piece) => "a piece of such things",
                Some(Inner::Filler) => "a form, side or material",
                Some(Inner::Known) => "in no list, but known",
                Some(Inner::Unknown) => "in no list, or unknown",
            };
            let [pairs, confidence] = [row.pairs as f64, row.confidence];
            writeln!(text, "| {kind} | {pairs:.0} | {inner:.1} | {joined:.1} | {both:.1} | {confidence:.2} | {sure}, {right:.1} |")?;
        }
        Ok(())
    }

    /// The suggestions for objects that nobody labelled.
    fn unlabelled(&self, text: &mut String) -> std::fmt::Result {
        let judgement = &self.measured[1].0.ours;
        let (mut all, mut sure) = (0, 0);
        for (group, suggestion) in self.groups.iter().zip(&judgement.suggestions) {
            let n = group.of_class(-1);
            all += n;
            sure += if suggestion.as_ref().is_some_and(|s| s.confidence >= self.threshold) { n } else { 0 };
        }
        let right: f64 =
            judgement.rows.iter().filter(|r| r.suggested.is_some_and(|(_, c)| c >= f64::from(self.threshold))).map(|r| r.right()).sum();
        let labelled: f64 = judgement.rows.iter().map(|row| row.objects()).sum();
        writeln!(
            text,
            "\n{:.1} % of the {all} objects that nobody labelled get a suggestion with a confidence of {} or more. No camera sees many of\n\
            them, so that says little; if all of these count as wrong, and having no suggestion for the others as right, {:.1} % of all\n\
            objects are right.\n",
            100.0 * sure as f64 / all as f64,
            self.threshold,
            100.0 * (right + (all - sure) as f64) / (labelled + all as f64),
        )
    }

    fn actions(&self, text: &mut String) -> std::fmt::Result {
        writeln!(text, "## Actions per scene\n")?;
        writeln!(
            text,
            "Simulated, with volumes held out: how many actions give the labelled objects of each scene their classes. Without suggestions, one\n\
            action labels what can be selected together: *one by one*, an instance, or the objects without one (walls, floors, ceilings) of one name\n\
            and class; *by name*, all objects of one name and class if the name has words, otherwise as before. With suggestions, one action confirms\n\
            all with a confidence of {} or more; what is wrong or missing costs as much as before. Numbering instances, and\n\
            looking at suggestions before they are confirmed, are not counted. *Named* scenes are those in which the names of nine\n\
            tenths of the labelled objects have words.\n",
            self.threshold
        )?;
        writeln!(
            text,
            "| actions per scene, mean (median) | scenes | without | with ours | with lookup | saved by ours |\n|---|---|---|---|---|---|"
        )?;
        for (name, named, of) in [
            ("one by one, all", false, singly as fn(&Actions) -> [f64; 2]),
            ("one by one, named", true, singly),
            ("by name, all", false, by_name),
            ("by name, named", true, by_name),
        ] {
            let [ours, lookup] = [0, 1].map(|i| chosen(&self.saved[i], named, of));
            let with = |list: &[[f64; 2]], i: usize| mean_and_median(list.iter().map(|pair| pair[i]));
            let ([before, m0], [after, m1], [theirs, m2]) = (with(&ours, 0), with(&ours, 1), with(&lookup, 1));
            let saved = 100.0 * (1.0 - after / before);
            writeln!(
                text,
                "| {name} | {} | {before:.1} ({m0:.0}) | {after:.1} ({m1:.0}) | {theirs:.1} ({m2:.0}) | **{saved:.0} %** |",
                ours.len()
            )?;
        }
        Ok(())
    }

    fn strangers(&self, text: &mut String) -> std::fmt::Result {
        writeln!(text, "\n## Names from other sources\n")?;
        writeln!(
            text,
            "These use the tables as shipped. Rooms are by other artists, labelled by material in `material_to_nyu40.csv`; homes are made by\n\
            `enfilade home`, with our names and labels.\n"
        )?;
        writeln!(
            text,
            "| scene | labelled parts | class right, % | sure (90 %): parts, right % | surest (95 %): parts, right % |\n|---|---|---|---|---|"
        )?;
        let percent = |right: usize, of: usize| 100.0 * right as f64 / of.max(1) as f64;
        for other in self.others {
            let Other { name, parts, right, sure: [sure, well], surest: [surest, best] } = other;
            let (a, b, c) = (percent(*right, *parts), percent(*well, *sure), percent(*best, *surest));
            writeln!(text, "| {name} | {parts} | {a:.1} | {sure}, {b:.1} | {surest}, {c:.1} |")?;
        }
        Ok(())
    }

    fn classes(&self, text: &mut String) -> std::fmt::Result {
        writeln!(text, "\n## By class\n\nNames of scenes, volumes held out; every suggestion counts, whatever its confidence.\n")?;
        writeln!(text, "| class | names | precision, % | recall, % |\n|---|---|---|---|")?;
        let mut sums = [0.0; 3];
        for class in NYU40 {
            let [names, precision, recall] = self.measured[1].0.ours.of_class(class.id);
            writeln!(text, "| {} | {names:.1} | {:.0} | {:.0} |", class.name, 100.0 * precision, 100.0 * recall)?;
            if names > 0.0 {
                sums = [sums[0] + 1.0, sums[1] + precision, sums[2] + recall];
            }
        }
        let [n, precision, recall] = sums;
        writeln!(text, "| **mean of the {n:.0} classes that occur** | | **{:.0}** | **{:.0}** |", 100.0 * precision / n, 100.0 * recall / n)
    }

    /// The benchmark's rows: ours beside the lookup of whole names; a ratio above 1 is in our favour.
    fn rows(&self) -> Vec<serde_json::Value> {
        let round = |x: f64| (x * 1000.0).round() / 1000.0;
        let row = |case: String, ours: f64, peer: f64, ratio: f64| serde_json::json!({ "case": case, "ours": round(ours), "peer": round(peer), "ratio": round(ratio) });
        let mut rows = Vec::new();
        for (Measured { split, ours, lookup, .. }, _) in self.measured {
            let held = match split {
                Split::Scene => "scenes",
                Split::Volume => "volumes",
            };
            let mut share = |case: &str, of: &dyn Fn(&Judgement) -> f64| {
                let (ours, peer) = (of(ours), of(lookup));
                rows.push(row(format!("{case}, {held} held out in {FOLDS} folds"), ours, peer, ours / peer));
            };
            share("names right", &|j| j.accuracy(By::Name, true));
            share("labelled objects right", &|j| j.accuracy(By::Object, false));
            share("names covered at 90 % precision", &|j| j.coverage(0.9, By::Name)[0]);
            share("names covered at 95 % precision", &|j| j.coverage(0.95, By::Name)[0]);
        }
        for (case, named, of) in [
            ("actions per named scene, one by one", true, singly as fn(&Actions) -> [f64; 2]),
            ("actions per named scene, by name", true, by_name),
        ] {
            let [ours, peer] = [0, 1].map(|i| mean_and_median(chosen(&self.saved[i], named, of).iter().map(|pair| pair[1]))[0]);
            rows.push(row(case.into(), ours, peer, peer / ours));
        }
        rows
    }
}

fn singly(actions: &Actions) -> [f64; 2] {
    actions.singly
}

fn by_name(actions: &Actions) -> [f64; 2] {
    actions.by_name
}

/// Actions without and with suggestions, of all scenes or of those that have named objects.
fn chosen(scenes: &[Actions], named: bool, of: fn(&Actions) -> [f64; 2]) -> Vec<[f64; 2]> {
    scenes.iter().filter(|scene| !named || scene.objects[1] >= 0.9 * scene.objects[0]).map(of).collect()
}

fn mean_and_median(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    [sorted.iter().sum::<f64>() / sorted.len() as f64, sorted[sorted.len() / 2]]
}
