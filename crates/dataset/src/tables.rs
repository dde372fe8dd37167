//! CSV tables, read by column name.

use crate::DatasetError;
use crate::atomic::write_bytes;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// A CSV file in memory.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    path: PathBuf,
    /// Names of the columns.
    pub header: Vec<String>,
    /// Rows of cells, as many in each as there are columns.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// An empty table that will be written to `path`.
    pub fn new(path: &Path, header: &[&str]) -> Self {
        Self { path: path.to_path_buf(), header: header.iter().map(ToString::to_string).collect(), rows: Vec::new() }
    }

    /// Reads the file at `path`; cells and names are trimmed.
    pub fn read(path: &Path) -> Result<Self, DatasetError> {
        let text = std::fs::read(path).map_err(DatasetError::at("read", path))?;
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(text.as_slice());
        let wrong = |error: csv::Error| DatasetError::text(path, format!("not a table of comma-separated values: {error}"));
        let cells = |record: &csv::StringRecord| record.iter().map(ToString::to_string).collect();
        let header = cells(reader.headers().map_err(wrong)?);
        let rows = reader.records().map(|record| record.map(|r| cells(&r)).map_err(wrong)).collect::<Result<_, _>>()?;
        Ok(Self { path: path.to_path_buf(), header, rows })
    }

    /// Replaces the file by this table.
    pub fn write(&self) -> Result<(), DatasetError> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let unwritable = |error: csv::Error| DatasetError::text(&self.path, format!("the table cannot be written: {error}"));
        for row in std::iter::once(&self.header).chain(&self.rows) {
            writer.write_record(row).map_err(unwritable)?;
        }
        let bytes = writer.into_inner().map_err(|error| DatasetError::text(&self.path, format!("the table cannot be written: {error}")))?;
        write_bytes(&self.path, bytes)
    }

    /// Index of a column.
    pub fn column(&self, name: &str) -> Result<usize, DatasetError> {
        self.header
            .iter()
            .position(|column| column == name)
            .ok_or_else(|| DatasetError::text(&self.path, format!("line 1: no column {name:?}, only {}", self.header.join(", "))))
    }

    /// Indices of several columns.
    pub fn columns<const N: usize>(&self, names: [&str; N]) -> Result<[usize; N], DatasetError> {
        let mut at = [0; N];
        for (at, name) in at.iter_mut().zip(names) {
            *at = self.column(name)?;
        }
        Ok(at)
    }

    /// The cell in `row` and `column` as a number or other plain value.
    pub fn parse<T: FromStr>(&self, row: usize, column: usize) -> Result<T, DatasetError> {
        let cell = &self.rows[row][column];
        cell.parse().map_err(|_| {
            let expected = std::any::type_name::<T>();
            DatasetError::text(
                &self.path,
                format!("line {}, column {:?}: expected {expected}, found {cell:?}", row + 2, self.header[column]),
            )
        })
    }

    /// The value of a parameter in a table of `parameter_name,parameter_value`.
    pub fn parameter<T: FromStr>(&self, name: &str) -> Result<T, DatasetError> {
        let (names, values) = (self.column("parameter_name")?, self.column("parameter_value")?);
        let row = self.rows.iter().position(|row| row[names] == name);
        let row = row.ok_or_else(|| DatasetError::text(&self.path, format!("no row for the parameter {name:?}")))?;
        self.parse(row, values)
    }
}

/// Writes a table of `parameter_name,parameter_value`.
pub(crate) fn write_parameters(path: &Path, parameters: &[(&str, f64)]) -> Result<(), DatasetError> {
    let mut table = Table::new(path, &["parameter_name", "parameter_value"]);
    table.rows = parameters.iter().map(|(name, value)| vec![(*name).to_string(), format!("{value:?}")]).collect();
    table.write()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_with_commas_quotes_and_lines_come_back() {
        let folder = tempfile::tempdir().unwrap();
        let mut table = Table::new(&folder.path().join("t.csv"), &["a", "b"]);
        table.rows = vec![vec!["sofa, left".into(), "\"quoted\"".into()], vec!["two\nlines".into(), String::new()]];
        table.write().unwrap();
        let back = Table::read(&table.path).unwrap();
        assert_eq!((back.header, back.rows), (table.header, table.rows));
    }

    #[test]
    fn a_bad_cell_is_named_by_line_and_column() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("metadata_scene.csv");
        std::fs::write(&path, "parameter_name,parameter_value\nmeters_per_asset_unit,one\n").unwrap();
        let message = Table::read(&path).unwrap().parameter::<f64>("meters_per_asset_unit").unwrap_err().to_string();
        assert!(message.ends_with("metadata_scene.csv: line 2, column \"parameter_value\": expected f64, found \"one\""), "{message}");
        std::fs::write(&path, "parameter_name,parameter_value\na,b,c\n").unwrap();
        assert!(Table::read(&path).unwrap_err().to_string().contains("metadata_scene.csv"));
    }
}
