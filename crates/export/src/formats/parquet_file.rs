//! A Parquet file of frames as the library `datasets` of Hugging Face wants it: pictures in its layout of `Image`, matrices as lists of rows.
//!
//! Every value except names, numbers and poses may be missing. The file describes its features itself, under the key "huggingface".

use crate::ExportError;
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int32Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::parser::parse_message_type;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The columns of pictures.
pub(super) const PICTURES: [&str; 4] = ["image", "depth", "semantic", "instance"];

/// A group of rows ends with this many bytes of pictures, so that readers need not keep more in memory.
const GROUP_BYTES: u64 = 64 << 20;

/// The bytes of a picture's file, and its name.
pub(super) type NamedPicture = (Vec<u8>, String);

/// One frame.
pub(super) struct Row {
    pub scene: String,
    pub camera: String,
    pub frame: u32,
    pub size: [u32; 2],
    /// Bytes of PNG files and their names, in the order of [`PICTURES`].
    pub pictures: [Option<NamedPicture>; 4],
    pub depth_kind: &'static str,
    pub model: &'static str,
    pub k: Option<[[f64; 3]; 3]>,
    pub distortion: Vec<f64>,
    pub world_from_camera: [[f64; 4]; 4],
}

impl Row {
    /// Bytes of its pictures, which are nearly all that it takes.
    pub fn bytes(&self) -> u64 {
        self.pictures.iter().flatten().map(|(bytes, _)| bytes.len() as u64).sum()
    }
}

/// The columns in order: name and kind.
#[derive(Clone, Copy)]
pub(super) enum Column {
    Text(fn(&Row) -> &str),
    Number(fn(&Row) -> u32),
    Picture(usize),
    List(fn(&Row) -> &[f64]),
    Matrix(fn(&Row) -> Option<Vec<&[f64]>>),
}

/// The table of columns.
pub(super) const COLUMNS: [(&str, Column); 14] = [
    ("scene", Column::Text(|row| &row.scene)),
    ("camera", Column::Text(|row| &row.camera)),
    ("frame", Column::Number(|row| row.frame)),
    ("width", Column::Number(|row| row.size[0])),
    ("height", Column::Number(|row| row.size[1])),
    (PICTURES[0], Column::Picture(0)),
    (PICTURES[1], Column::Picture(1)),
    (PICTURES[2], Column::Picture(2)),
    (PICTURES[3], Column::Picture(3)),
    ("depth_kind", Column::Text(|row| row.depth_kind)),
    ("model", Column::Text(|row| row.model)),
    ("K", Column::Matrix(|row| row.k.as_ref().map(|k| k.iter().map(|row| &row[..]).collect()))),
    ("distortion", Column::List(|row| &row.distortion)),
    ("world_from_camera", Column::Matrix(|row| Some(row.world_from_camera.iter().map(|row| &row[..]).collect()))),
];

/// A file in the making.
pub(super) struct ParquetFile {
    path: PathBuf,
    writer: SerializedFileWriter<File>,
    waiting: Vec<Row>,
    waiting_bytes: u64,
    /// Bytes of the rows that it has.
    pub bytes: u64,
}

impl ParquetFile {
    pub fn create(path: PathBuf) -> Result<Self, ExportError> {
        let file = File::create(&path).map_err(ExportError::at("write", &path))?;
        let features = serde_json::json!({ "info": { "features": features() } });
        let properties = WriterProperties::builder()
            .set_key_value_metadata(Some(vec![KeyValue::new("huggingface".into(), features.to_string())]))
            // PNG files are compressed, and no two of them alike.
            .set_dictionary_enabled(false)
            .set_statistics_enabled(EnabledStatistics::None);
        let schema = Arc::new(parse_message_type(&schema()).expect("the schema is one"));
        let writer = SerializedFileWriter::new(file, schema, Arc::new(properties.build())).map_err(at(&path))?;
        Ok(Self { path, writer, waiting: Vec::new(), waiting_bytes: 0, bytes: 0 })
    }

    pub fn add(&mut self, row: Row) -> Result<(), ExportError> {
        self.waiting_bytes += row.bytes();
        self.bytes += row.bytes();
        self.waiting.push(row);
        if self.waiting_bytes >= GROUP_BYTES { self.write_group() } else { Ok(()) }
    }

    /// Ends the file and gives its length.
    pub fn close(mut self) -> Result<u64, ExportError> {
        self.write_group()?;
        self.writer.finish().map_err(at(&self.path))?;
        Ok(self.path.metadata().map_err(ExportError::at("write", &self.path))?.len())
    }

    fn write_group(&mut self) -> Result<(), ExportError> {
        if self.waiting.is_empty() {
            return Ok(());
        }
        let rows = std::mem::take(&mut self.waiting);
        self.waiting_bytes = 0;
        let mut group = self.writer.next_row_group().map_err(at(&self.path))?;
        let written = COLUMNS.iter().try_for_each(|(_, column)| write_column(&mut group, *column, &rows));
        written.and_then(|()| group.close().map(drop)).map_err(at(&self.path))
    }
}

fn at(path: &Path) -> impl FnOnce(ParquetError) -> ExportError {
    let path = path.to_path_buf();
    move |error| ExportError::Io { action: "write", path, source: std::io::Error::other(error) }
}

fn schema() -> String {
    let double = "optional double element;";
    let list = |name: &str, of: &str| format!("optional group {name} (LIST) {{ repeated group list {{ {of} }} }}");
    let column = |(name, column): &(&str, Column)| match column {
        Column::Text(_) => format!("optional binary {name} (UTF8);"),
        Column::Number(_) => format!("optional int32 {name};"),
        Column::Picture(_) => format!("optional group {name} {{ optional binary bytes; optional binary path (UTF8); }}"),
        Column::List(_) => list(name, double),
        Column::Matrix(_) => list(name, &list("element", double)),
    };
    format!("message frames {{ {} }}", COLUMNS.iter().map(column).collect::<String>())
}

/// The features in the words of `datasets`.
fn features() -> serde_json::Value {
    let value = |dtype: &str| serde_json::json!({ "dtype": dtype, "_type": "Value" });
    let list = |of: serde_json::Value| serde_json::json!({ "feature": of, "_type": "Sequence" });
    let feature = |column: &Column| match column {
        Column::Text(_) => value("string"),
        Column::Number(_) => value("int32"),
        Column::Picture(_) => serde_json::json!({ "_type": "Image" }),
        Column::List(_) => list(value("float64")),
        Column::Matrix(_) => list(list(value("float64"))),
    };
    COLUMNS.iter().map(|(name, column)| (name.to_string(), feature(column))).collect::<serde_json::Map<_, _>>().into()
}

fn write_column(group: &mut SerializedRowGroupWriter<'_, File>, column: Column, rows: &[Row]) -> Result<(), ParquetError> {
    match column {
        Column::Text(of) => write::<ByteArrayType>(group, rows.iter().map(|row| one(ByteArray::from(of(row)), 1))),
        Column::Number(of) => write::<Int32Type>(group, rows.iter().map(|row| one(of(row) as i32, 1))),
        Column::Picture(which) => {
            let picture = |row: &'_ Row| row.pictures[which].clone();
            let bytes = rows.iter().map(|row| picture(row).map_or(Leaf::default(), |(bytes, _)| one(ByteArray::from(bytes), 2)));
            write::<ByteArrayType>(group, bytes)?;
            let names = rows.iter().map(|row| picture(row).map_or(Leaf::default(), |(_, name)| one(ByteArray::from(name.as_str()), 2)));
            write::<ByteArrayType>(group, names)
        }
        Column::List(of) => write::<DoubleType>(group, rows.iter().map(|row| list(of(row)))),
        Column::Matrix(of) => write::<DoubleType>(group, rows.iter().map(|row| of(row).map_or(Leaf::default(), matrix))),
    }
}

/// The part of a column in one row: values, and levels of definition and repetition.
struct Leaf<T> {
    values: Vec<T>,
    defined: Vec<i16>,
    repeated: Vec<i16>,
}

/// Nothing.
impl<T> Default for Leaf<T> {
    fn default() -> Self {
        Self { values: Vec::new(), defined: vec![0], repeated: vec![0] }
    }
}

/// One value, at the end of that many optional levels.
fn one<T>(value: T, level: i16) -> Leaf<T> {
    Leaf { values: vec![value], defined: vec![level], repeated: vec![0] }
}

fn list(values: &[f64]) -> Leaf<f64> {
    if values.is_empty() {
        return Leaf { defined: vec![1], ..Leaf::default() };
    }
    let repeated = (0..values.len()).map(|i| i16::from(i > 0)).collect();
    Leaf { values: values.to_vec(), defined: vec![3; values.len()], repeated }
}

/// A list of rows, none of which is empty.
fn matrix(rows: Vec<&[f64]>) -> Leaf<f64> {
    let values = rows.concat();
    let of_row = |(i, row): (usize, &&[f64])| (0..row.len()).map(move |j| if j > 0 { 2 } else { i16::from(i > 0) }).collect::<Vec<_>>();
    Leaf { defined: vec![5; values.len()], repeated: rows.iter().enumerate().flat_map(of_row).collect(), values }
}

/// Row by row, so that pages end between pictures.
fn write<D: DataType>(group: &mut SerializedRowGroupWriter<'_, File>, rows: impl Iterator<Item = Leaf<D::T>>) -> Result<(), ParquetError> {
    let mut column = group.next_column()?.expect("as many columns as the schema has");
    for leaf in rows {
        column.typed::<D>().write_batch(&leaf.values, Some(&leaf.defined), Some(&leaf.repeated))?;
    }
    column.close()
}
