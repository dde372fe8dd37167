//! Agreement of predicted classes with true ones: the confusion matrix, and metrics computed from it.
//!
//! Intersection over union of a class is TP / (TP + FP + FN) (Everingham et al., "The Pascal Visual Object Classes Challenge", IJCV 2010),
//! with the pixels of all images in one matrix. Mean IoU is the mean over the classes that occur, in truth or prediction.

/// Numbers of pixels by true class (row) and predicted class (column), both counted from 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Confusion {
    classes: usize,
    counts: Vec<u64>,
}

/// A pixel that cannot be counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ConfusionError {
    /// Different numbers of predictions and truths.
    #[error("{predicted} predictions for {truths} true classes; expected as many")]
    Lengths {
        /// Predictions.
        predicted: usize,
        /// Truths.
        truths: usize,
    },
    /// A number that is no class.
    #[error("{what} {found} at place {place} is no class: expected 0 to {} or, in the truth, the value to ignore", classes - 1)]
    NoClass {
        /// "prediction" or "true class".
        what: &'static str,
        /// The number.
        found: i64,
        /// Index among the values.
        place: usize,
        /// Number of classes.
        classes: usize,
    },
    /// Matrices of different sets of classes.
    #[error("a matrix of {found} classes, expected {expected}")]
    Classes {
        /// Classes of the other matrix.
        found: usize,
        /// Classes of this matrix.
        expected: usize,
    },
}

impl Confusion {
    /// An empty matrix.
    ///
    /// # Panics
    /// When there are no classes.
    pub fn new(classes: usize) -> Self {
        assert!(classes > 0, "a confusion matrix of no classes");
        Self { classes, counts: vec![0; classes * classes] }
    }

    /// A matrix of these counts.
    ///
    /// # Panics
    /// When there are not `classes` × `classes`.
    pub fn of_counts(classes: usize, counts: Vec<u64>) -> Self {
        assert_eq!(counts.len(), classes * classes, "counts of {classes} classes");
        Self { classes, counts }
    }

    /// Number of classes.
    pub fn classes(&self) -> usize {
        self.classes
    }

    /// Pixels by true class and predicted class, row by row.
    pub fn counts(&self) -> &[u64] {
        &self.counts
    }

    /// Counts pixels, except those whose truth is `ignore`. All pixels are counted or, on an error, none.
    ///
    /// # Errors
    /// If a number is not a class, or the numbers of predictions and truths differ.
    pub fn add<P: Copy + Into<i64>, T: Copy + Into<i64>>(
        &mut self,
        prediction: &[P],
        truth: &[T],
        ignore: i64,
    ) -> Result<(), ConfusionError> {
        if prediction.len() != truth.len() {
            return Err(ConfusionError::Lengths { predicted: prediction.len(), truths: truth.len() });
        }
        let classes = self.classes;
        let class = |what, found: i64, place| {
            let known = usize::try_from(found).ok().filter(|&class| class < classes);
            known.ok_or(ConfusionError::NoClass { what, found, place, classes })
        };
        let mut counts = vec![0; self.counts.len()];
        for (place, (&predicted, &truth)) in prediction.iter().zip(truth).enumerate() {
            let truth = truth.into();
            if truth != ignore {
                counts[class("true class", truth, place)? * classes + class("prediction", predicted.into(), place)?] += 1;
            }
        }
        self.counts.iter_mut().zip(counts).for_each(|(sum, count)| *sum += count);
        Ok(())
    }

    /// Adds the pixels of another matrix.
    ///
    /// # Errors
    /// When it is of another number of classes.
    pub fn merge(&mut self, other: &Self) -> Result<(), ConfusionError> {
        if other.classes != self.classes {
            return Err(ConfusionError::Classes { found: other.classes, expected: self.classes });
        }
        self.counts.iter_mut().zip(&other.counts).for_each(|(sum, count)| *sum += count);
        Ok(())
    }

    /// Intersection over union of each class; `None` where a class occurs neither in truth nor in prediction.
    pub fn iou(&self) -> Vec<Option<f64>> {
        let at = |truth: usize, predicted: usize| self.counts[truth * self.classes + predicted];
        let class = |class: usize| {
            let (truth, predicted): (u64, u64) =
                (0..self.classes).map(|other| (at(class, other), at(other, class))).fold((0, 0), |a, b| (a.0 + b.0, a.1 + b.1));
            let (both, either) = (at(class, class), truth + predicted - at(class, class));
            (either > 0).then(|| both as f64 / either as f64)
        };
        (0..self.classes).map(class).collect()
    }

    /// Mean of the intersections over union of the classes that occur; `None` without pixels.
    pub fn mean_iou(&self) -> Option<f64> {
        let known: Vec<f64> = self.iou().into_iter().flatten().collect();
        (!known.is_empty()).then(|| known.iter().sum::<f64>() / known.len() as f64)
    }

    /// Share of pixels whose class is right; `None` without pixels.
    pub fn accuracy(&self) -> Option<f64> {
        let right: u64 = (0..self.classes).map(|class| self.counts[class * (self.classes + 1)]).sum();
        let all = self.pixels();
        (all > 0).then(|| right as f64 / all as f64)
    }

    /// Number of pixels that were counted.
    pub fn pixels(&self) -> u64 {
        self.counts.iter().sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// True 0: 3 right, 1 taken for 1. True 1: 2 right. True 2: 1 taken for 0. Class 3 does not occur. Two pixels are void.
    fn example() -> Confusion {
        let mut found = Confusion::new(4);
        found.add(&[0_i32, 0, 0, 1, 1, 1, 0, 3, -9], &[0_i16, 0, 0, 0, 1, 1, 2, -1, -1], -1).unwrap();
        found
    }

    #[test]
    fn a_case_by_hand() {
        let found = example();
        assert_eq!(found.counts(), [3, 1, 0, 0, 0, 2, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0]);
        assert_eq!(found.iou(), [Some(3.0 / 5.0), Some(2.0 / 3.0), Some(0.0), None]);
        assert_eq!(found.mean_iou(), Some((3.0 / 5.0 + 2.0 / 3.0) / 3.0));
        assert_eq!((found.accuracy(), found.pixels()), (Some(5.0 / 7.0), 7));
    }

    #[test]
    fn merging_is_counting_in_parts() {
        let mut parts = Confusion::new(4);
        parts.add(&[0_i32, 0, 0], &[0_i16, 0, 0], -1).unwrap();
        let mut rest = Confusion::new(4);
        rest.add(&[1_i32, 1, 1, 0], &[0_i16, 1, 1, 2], -1).unwrap();
        parts.merge(&rest).unwrap();
        assert_eq!(parts, example());
        assert!(parts.merge(&Confusion::new(3)).unwrap_err().to_string().contains("3 classes, expected 4"));
    }

    #[test]
    fn what_is_no_class_is_refused_and_nothing_counted() {
        let mut found = Confusion::new(4);
        for (prediction, truth, said) in [
            (vec![0_i32, 4], vec![1_i32, 1], "prediction 4 at place 1"),
            (vec![0, 0], vec![1, 7], "true class 7"),
            (vec![0], vec![1, 1], "1 predictions for 2"),
        ] {
            let error = found.add(&prediction, &truth, -1).unwrap_err().to_string();
            assert!(error.contains(said), "{error}");
        }
        assert_eq!(found, Confusion::new(4));
        assert_eq!((found.mean_iou(), found.accuracy()), (None, None));
    }

    #[test]
    fn perfect_and_entirely_wrong_predictions() {
        let truth: Vec<i32> = (0..100).map(|i| i % 5).collect();
        let wrong: Vec<i32> = truth.iter().map(|class| (class + 1) % 5).collect();
        let score = |prediction: &[i32]| {
            let mut found = Confusion::new(5);
            found.add(prediction, &truth, -1).unwrap();
            (found.mean_iou(), found.accuracy())
        };
        assert_eq!((score(&truth), score(&wrong)), ((Some(1.0), Some(1.0)), (Some(0.0), Some(0.0))));
    }
}
