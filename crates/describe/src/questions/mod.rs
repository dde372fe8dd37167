//! Questions about the frames of a camera, with answers: about all frames together, as a video, in the kinds of VSI-Bench (Yang et al.
//! 2025, "Thinking in Space"), and about single frames.

mod frame;
mod place;
mod video;

pub use frame::of_frame;
pub use video::of_video;

use enfilade_dataset::Question;
use enfilade_math::{Rng, hash_text};

/// Collects the questions of a camera.
pub struct Asker<'a> {
    scene: &'a str,
    camera: &'a str,
    rng: Rng,
    pub asked: Vec<Question>,
}

/// The right answer.
pub enum Answer {
    /// A number or word.
    Open(String),
    /// One of several: the right one, and wrong ones. They are shuffled.
    Choice { right: String, wrong: Vec<String> },
    /// Options in this fixed order; the index of the right one.
    Ordered(Vec<String>, usize),
}

impl<'a> Asker<'a> {
    /// Nothing is asked yet. The order of options follows from the names of scene and camera.
    pub fn new([scene, camera]: [&'a str; 2]) -> Self {
        Self { scene, camera, rng: Rng::new(hash_text(&format!("{scene}/{camera}"))), asked: Vec::new() }
    }

    /// Asks, of one frame or of all.
    pub fn ask(&mut self, frame: Option<u32>, kind: &str, question: String, answer: Answer, instances: &[i16]) {
        let letter = |i: usize| char::from(b'A' + i as u8);
        let (options, ground_truth) = match answer {
            Answer::Open(truth) => (None, truth),
            Answer::Ordered(options, right) => (Some(options), letter(right).to_string()),
            Answer::Choice { right, wrong } => {
                let mut options: Vec<(String, bool)> = wrong.into_iter().map(|word| (word, false)).chain([(right, true)]).collect();
                self.shuffle(&mut options);
                let right = options.iter().position(|(_, right)| *right).unwrap_or_default();
                (Some(options.into_iter().map(|(word, _)| word).collect()), letter(right).to_string())
            }
        };
        let lettered = |options: Vec<String>| options.iter().enumerate().map(|(i, word)| format!("{}. {word}", letter(i))).collect();
        self.asked.push(Question {
            id: format!("{}/{}/{}", self.scene, self.camera, self.asked.len()),
            dataset: "enfilade".into(),
            scene_name: self.scene.into(),
            camera: self.camera.into(),
            frame,
            question_type: kind.into(),
            question,
            options: options.map(lettered),
            ground_truth,
            instances: instances.to_vec(),
        });
    }

    /// Puts a list into a random order.
    pub fn shuffle<T>(&mut self, list: &mut [T]) {
        self.rng.shuffle(list);
    }
}
