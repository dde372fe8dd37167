//! `cargo xtask bench products`: every kind of ground truth made of the demo, with its cost and a picture.
//!
//! The measurement is a Python program, `xtask/python/bench_products.py`, which writes `docs/benchmarks/products.md`, `products.json` and the
//! pictures of `docs/ground-truth.md`.

use crate::house::House;
use crate::python;
use crate::step::finish;

/// Makes everything with the release build, measures it, and takes pictures of it.
///
/// # Errors
/// When something cannot be built or made, or there is no network for the Python that looks at it.
pub fn run(house: &House) -> Result<(), String> {
    finish(house.cargo(&["build", "--release", "--locked", "--package", "enfilade"]))?;
    let program = house.target()?.join("release").join(format!("enfilade{}", std::env::consts::EXE_SUFFIX));
    let python = python::made(house, "venv-products", "import h5py, PIL", &["h5py", "pillow"])?;
    let mut measure = house.command(python, &["xtask/python/bench_products.py"]);
    measure.arg(program).arg(house.target()?.join("products")).arg("docs");
    finish(measure).map(|_| ())
}
