//! The tables of the crate as CSV: their header, rows with line numbers, and the errors for damage.

use enfilade_scene::NYU40;

/// A table that cannot be used: file, line from 1, what was found and what was expected.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}:{line}: {problem}")]
pub struct TableError {
    /// The file, as the caller calls it.
    pub file: String,
    /// Line from 1.
    pub line: u64,
    /// The problem found, and what was expected.
    pub problem: String,
}

/// The rows of a table of exactly these columns, with their lines.
pub(crate) fn read<const N: usize>(text: &str, file: &str, columns: [&str; N]) -> Result<Vec<(u64, [String; N])>, TableError> {
    let error = |line, problem: String| TableError { file: file.into(), line, problem };
    let mut reader = csv::ReaderBuilder::new().from_reader(text.as_bytes());
    let header = reader.headers().map_err(|e| error(1, e.to_string()))?;
    if header.iter().ne(columns) {
        let found = header.iter().collect::<Vec<_>>().join(", ");
        return Err(error(1, format!("expected the columns {}, found {found:?}; take the file as it was released", columns.join(", "))));
    }
    let rows = reader.into_records().map(|record| {
        let record = record.map_err(|e| error(e.position().map_or(1, csv::Position::line), e.to_string()))?;
        let line = record.position().map_or(1, csv::Position::line);
        Ok((line, std::array::from_fn(|i| record[i].to_string())))
    });
    rows.collect()
}

/// The number of a class of this name.
pub(crate) fn class_number(name: &str) -> Result<i16, String> {
    let class = NYU40.iter().find(|class| class.name == name);
    class
        .map(|class| class.id)
        .ok_or_else(|| format!("unknown class {name:?}; expected one of {}", NYU40.map(|class| class.name).join(", ")))
}

/// A finite number.
pub(crate) fn number(text: &str, what: &str) -> Result<f32, String> {
    text.parse().ok().filter(|x: &f32| x.is_finite()).ok_or_else(|| format!("{what} {text:?} is no finite number"))
}
