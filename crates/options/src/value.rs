//! Types that options may have.

use crate::form::{Form, Given};
use std::path::PathBuf;

/// A type whose values can be given on the command line and in Python.
pub trait Value: Sized {
    /// Form of the values.
    const FORM: Form;

    /// The value that is given; `None` when it is not of the form.
    fn read(given: &Given) -> Option<Self>;
}

impl Value for bool {
    const FORM: Form = Form::Switch;

    fn read(given: &Given) -> Option<Self> {
        if let Given::Switch(value) = given { Some(*value) } else { None }
    }
}

impl Value for u32 {
    const FORM: Form = Form::Whole { least: 0, most: u32::MAX as u64 };

    fn read(given: &Given) -> Option<Self> {
        u64::read(given)?.try_into().ok()
    }
}

impl Value for u64 {
    const FORM: Form = Form::Whole { least: 0, most: u64::MAX };

    fn read(given: &Given) -> Option<Self> {
        if let Given::Whole(value) = given { Some(*value) } else { None }
    }
}

impl Value for i64 {
    const FORM: Form = Form::Integer;

    fn read(given: &Given) -> Option<Self> {
        match given {
            Given::Integer(value) => Some(*value),
            Given::Whole(value) => (*value).try_into().ok(),
            _ => None,
        }
    }
}

impl Value for f64 {
    const FORM: Form = Form::Number;

    fn read(given: &Given) -> Option<Self> {
        match given {
            Given::Number(value) => Some(*value),
            Given::Whole(value) => Some(*value as f64),
            Given::Integer(value) => Some(*value as f64),
            _ => None,
        }
    }
}

impl Value for f32 {
    const FORM: Form = Form::Number;

    fn read(given: &Given) -> Option<Self> {
        f64::read(given).map(|value| value as f32)
    }
}

impl Value for String {
    const FORM: Form = Form::Text;

    fn read(given: &Given) -> Option<Self> {
        given.text().map(String::from)
    }
}

impl Value for PathBuf {
    const FORM: Form = Form::Path;

    fn read(given: &Given) -> Option<Self> {
        if let Given::Path(path) = given { Some(path.clone()) } else { given.text().map(Self::from) }
    }
}

impl Value for (String, u32) {
    const FORM: Form = Form::Frame;

    fn read(given: &Given) -> Option<Self> {
        let Given::List(values) = given else { return None };
        let [camera, frame] = values.as_slice() else { return None };
        Some((String::read(camera)?, u32::read(frame)?))
    }
}

impl Value for [(String, u32); 2] {
    const FORM: Form = Form::Two(&Form::Frame);

    fn read(given: &Given) -> Option<Self> {
        Vec::read(given)?.try_into().ok()
    }
}

impl Value for [u32; 2] {
    const FORM: Form = Form::Size;

    fn read(given: &Given) -> Option<Self> {
        Vec::read(given)?.try_into().ok()
    }
}

impl<const N: usize> Value for [f64; N] {
    const FORM: Form = Form::List(&Form::Number);

    fn read(given: &Given) -> Option<Self> {
        Vec::read(given)?.try_into().ok()
    }
}

impl<const N: usize> Value for [[f64; N]; 2] {
    const FORM: Form = Form::Two(&Form::List(&Form::Number));

    fn read(given: &Given) -> Option<Self> {
        Vec::read(given)?.try_into().ok()
    }
}

impl<T: Value> Value for Option<T> {
    const FORM: Form = T::FORM;

    fn read(given: &Given) -> Option<Self> {
        T::read(given).map(Some)
    }
}

impl<T: Value> Value for Vec<T> {
    const FORM: Form = Form::List(&T::FORM);

    fn read(given: &Given) -> Option<Self> {
        if let Given::List(values) = given { values.iter().map(T::read).collect() } else { None }
    }
}
