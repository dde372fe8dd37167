//! The label table: a CSV file whose rows assign classes to parts or materials.
//!
//! Columns are found by their header, in any order; others are ignored. Commas, semicolons or tabs separate them; the text is UTF-8, UTF-16
//! or Windows-1252, with or without a byte order mark. As pandas and spreadsheets write them, whole numbers may be `1.0` (`1,0` between
//! semicolons), cells without a value `nan`, and rows empty.
//!
//! | column | meaning |
//! |---|---|
//! | `scene` | optional; the row is for this scene only, or for all when empty or `*` |
//! | `part` | name of a part |
//! | `object` | name of an object, or of a parent of objects, alone or with its parents before it (`World/chair_1`): all its parts, as one
//! instance; the part of that name; all parts `object/…` |
//! | `name` | name of a part, an object, a parent of objects, or a material, whichever there is |
//! | `material` | name of a material: all parts that wear it |
//! | `nyu40_id` or `semantic` | class by NYU40 number or name; −1, 0 (NYU40's own) or empty for unlabelled |
//! | `nyu40_name` | optional; checked against the class |
//! | `instance` | optional; instance number from 1, −1 for none, empty for automatic |
//!
//! At least one of the four name columns is needed; where a row fills several, the first in the order above counts.

use enfilade_scene::{GIT_LFS_POINTER, Labels, NYU40, PartLabel, Scene, decoded_text, is_git_lfs_pointer};
use std::collections::HashMap;

/// A parsed label table.
#[derive(Clone, Debug, PartialEq)]
pub struct LabelTable {
    pub(super) rows: Vec<Row>,
    ignored: Vec<String>,
}

/// One row of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// Line of the file, from 1.
    pub line: u64,
    /// The only scene it is for; `None` for all.
    pub scene: Option<String>,
    /// Kind of thing that the name refers to.
    pub subject: Subject,
    /// The name.
    pub name: String,
    /// NYU40 class, 1 to 40, or −1.
    pub semantic: i16,
    /// Instance number from 1 or −1, if the row states one.
    pub instance: Option<i16>,
}

/// Kind of thing that the name in a row refers to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Subject {
    /// One part.
    Part,
    /// All parts of an object.
    Object,
    /// A part, else an object, else a material.
    Name,
    /// All parts that wear a material.
    Material,
}

/// Why a table cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TableError {
    /// A needed column is not there.
    #[error("{file}:1: no column {expected}; the header has: {found}")]
    MissingColumn {
        /// The file.
        file: String,
        /// The names any of which would do.
        expected: &'static str,
        /// The header.
        found: String,
    },
    /// A row is wrong.
    #[error("{file}:{line}: {problem}")]
    Row {
        /// The file.
        file: String,
        /// Line from 1.
        line: u64,
        /// The problem found, and what was expected.
        problem: String,
    },
}

const SUBJECTS: [(Subject, &str); 4] =
    [(Subject::Part, "part"), (Subject::Object, "object"), (Subject::Name, "name"), (Subject::Material, "material")];

/// All columns that are read.
const COLUMNS: [&str; 9] = ["scene", "part", "object", "name", "material", "nyu40_id", "semantic", "nyu40_name", "instance"];

/// Bytes that show what a file is, and how a page of the web begins.
const HEAD: usize = 1024;
const PAGE: &str = "<!doctype html";

/// Separators of the cells of a row. Where the comma is the decimal point, spreadsheets write semicolons.
const SEPARATORS: [u8; 3] = [b',', b';', b'\t'];

impl LabelTable {
    /// Reads a table. `source_name` is what errors call it.
    ///
    /// # Errors
    /// The first missing column or wrong row: not CSV, unknown class, number out of range, class and name that disagree, or two rows about
    /// the same thing that differ.
    pub fn parse(bytes: &[u8], source_name: &str) -> Result<Self, TableError> {
        if is_git_lfs_pointer(bytes) {
            return Err(row_error(source_name, 1, format!("the file is {GIT_LFS_POINTER}")));
        }
        if let Some((what, remedy)) = other_than_table(bytes) {
            return Err(row_error(source_name, 1, format!("the file is {what}, not a table (CSV); {remedy}")));
        }
        let text = decoded_text(bytes);
        let bytes = without_hint(&text).as_bytes();
        let mut reader = reader(bytes, separator(bytes));
        let header = reader.headers().map_err(|e| row_error(source_name, 1, csv_problem(&e)))?.clone();
        let columns = Columns::find(&header, source_name)?;
        let mut rows = Vec::new();
        for record in reader.records() {
            let record = record.map_err(|e| row_error(source_name, e.position().map_or(1, csv::Position::line), csv_problem(&e)))?;
            let line = record.position().map_or(1, |p| p.line() + blank_lines(bytes, p.byte()));
            if record.iter().all(str::is_empty) {
                continue;
            }
            rows.extend(columns.row(&record, line).map_err(|problem| row_error(source_name, line, problem))?);
        }
        refuse_contradictions(&rows, source_name)?;
        let is_known = |name: &&str| name.is_empty() || COLUMNS.iter().any(|known| is_called(name, known));
        let ignored = header.iter().filter(|name| !is_known(name)).map(str::to_string).collect();
        Ok(Self { rows, ignored })
    }

    /// Columns that say nothing of labels, by their header.
    pub fn ignored(&self) -> &[String] {
        &self.ignored
    }

    /// The rows, in the order of the file.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }
}

/// The table that gives the parts of `scene` these labels: columns part, `nyu40_id`, `nyu40_name`, instance.
///
/// # Panics
/// When there is not one label per part.
pub fn write_table(scene: &Scene, labels: &Labels) -> String {
    let names: Vec<&str> = scene.parts.iter().map(|part| part.name.as_str()).collect();
    write_part_table(&names, &labels.parts)
}

/// The table that gives parts of these names these labels.
///
/// # Panics
/// When there is not one label per part.
pub fn write_part_table(parts: &[&str], labels: &[PartLabel]) -> String {
    assert_eq!(parts.len(), labels.len(), "one label per part");
    let mut writer = csv::Writer::from_writer(Vec::new());
    let mut write = |fields: [&str; 4]| writer.write_record(fields).expect("writing to memory cannot fail");
    write(["part", "nyu40_id", "nyu40_name", "instance"]);
    for (part, label) in parts.iter().zip(labels) {
        write([part, &label.semantic.to_string(), class_name(label.semantic), &label.instance.to_string()]);
    }
    String::from_utf8(writer.into_inner().expect("flushing memory cannot fail")).expect("names are UTF-8")
}

/// NYU40's name of a class; "unlabelled" for −1 and every number that is no class.
pub fn class_name(semantic: i16) -> &'static str {
    usize::try_from(semantic).ok().and_then(|id| NYU40.get(id.checked_sub(1)?)).map_or("unlabelled", |class| class.name)
}

/// Whether the head of a column is that of a known one.
fn is_called(head: &str, name: &str) -> bool {
    head.replace([' ', '-'], "_").eq_ignore_ascii_case(name)
}

/// Index of each known column.
struct Columns {
    scene: Option<usize>,
    subjects: Vec<(Subject, usize)>,
    class: usize,
    class_name: Option<usize>,
    instance: Option<usize>,
}

impl Columns {
    fn find(header: &csv::StringRecord, file: &str) -> Result<Self, TableError> {
        let find = |name: &str| header.iter().position(|h| is_called(h, name));
        let missing = |expected| TableError::MissingColumn {
            file: file.into(),
            expected,
            found: if header.is_empty() { "nothing".into() } else { header.iter().collect::<Vec<_>>().join(", ") },
        };
        let subjects: Vec<_> = SUBJECTS.iter().filter_map(|&(subject, name)| Some((subject, find(name)?))).collect();
        if subjects.is_empty() {
            return Err(missing("part, object, name or material"));
        }
        let class = find("nyu40_id").or_else(|| find("semantic")).ok_or_else(|| missing("nyu40_id or semantic"))?;
        Ok(Self { scene: find("scene"), subjects, class, class_name: find("nyu40_name"), instance: find("instance") })
    }

    /// A row; `None` if it is empty.
    fn row(&self, record: &csv::StringRecord, line: u64) -> Result<Option<Row>, String> {
        let cell = |column: Option<usize>| column.and_then(|c| record.get(c)).unwrap_or("");
        let scene = Some(cell(self.scene)).filter(|s| !s.is_empty() && *s != "*").map(str::to_string);
        let mut named = self.subjects.iter().map(|&(subject, column)| (subject, cell(Some(column))));
        let Some((subject, name)) = named.find(|(_, name)| !name.is_empty()) else {
            let says_nothing = [Some(self.class), self.class_name, self.instance].into_iter().all(|column| is_missing(cell(column)));
            let problem = || "the row names nothing; fill one of its name columns or remove it".to_string();
            return if says_nothing { Ok(None) } else { Err(problem()) };
        };
        let semantic = parse_class(cell(Some(self.class)))?;
        let stated = cell(self.class_name);
        if !is_missing(stated) && parse_class(stated)? != semantic {
            return Err(format!("class {semantic} is {}, but nyu40_name says {stated:?}; correct one of them", class_name(semantic)));
        }
        Ok(Some(Row { line, scene, subject, name: name.to_string(), semantic, instance: parse_instance(cell(self.instance))? }))
    }
}

/// A class by number or name.
fn parse_class(text: &str) -> Result<i16, String> {
    if is_missing(text) || ["unlabelled", "unlabeled"].iter().any(|n| text.eq_ignore_ascii_case(n)) {
        return Ok(-1);
    }
    if let Some(number) = whole_number(text) {
        return if matches!(number, -1 | 0) {
            Ok(-1)
        } else if (1..=40).contains(&number) {
            Ok(number as i16)
        } else {
            Err(format!("class {number} is out of range; expected 1 to 40, or -1 for unlabelled"))
        };
    }
    let name = letters(text);
    let name = if name == "refridgerator" { "refrigerator" } else { &name }; // the spelling of NYU's own list
    NYU40.iter().find(|class| class.name == name).map(|class| class.id).ok_or_else(|| {
        format!("unknown class {text:?}; expected a number from 1 to 40 or one of: {}", NYU40.map(|class| class.name).join(", "))
    })
}

/// The letters of a name in lower case: names such as `Floor_mat` and `night stand` are spelled in many ways.
fn letters(text: &str) -> String {
    text.chars().filter(|c| c.is_ascii_alphabetic()).map(|c| c.to_ascii_lowercase()).collect()
}

fn parse_instance(text: &str) -> Result<Option<i16>, String> {
    match whole_number(text).map(i16::try_from) {
        _ if is_missing(text) => Ok(None),
        Some(Ok(number)) if number == -1 || number >= 1 => Ok(Some(number)),
        _ => Err(format!("instance {text:?} is no instance number; expected 1 to 32767, -1 for none, or nothing")),
    }
}

/// Refuses two rows about the same thing that differ.
fn refuse_contradictions(rows: &[Row], file: &str) -> Result<(), TableError> {
    let mut first: HashMap<_, &Row> = HashMap::new();
    for row in rows {
        let earlier = *first.entry((&row.scene, row.subject, &row.name)).or_insert(row);
        if (earlier.semantic, earlier.instance) != (row.semantic, row.instance) {
            let says = |row: &Row| match row.instance {
                Some(instance) => format!("{} ({}), instance {instance}", row.semantic, class_name(row.semantic)),
                None => format!("{} ({})", row.semantic, class_name(row.semantic)),
            };
            let problem =
                format!("{:?} is {} here but {} in line {}; remove one of the rows", row.name, says(row), says(earlier), earlier.line);
            return Err(row_error(file, row.line, problem));
        }
    }
    Ok(())
}

/// True for a cell without a value, as spreadsheets and pandas write it.
fn is_missing(text: &str) -> bool {
    text.is_empty() || ["nan", "na", "n/a", "<na>", "null", "none"].iter().any(|word| text.eq_ignore_ascii_case(word))
}

/// A whole number, which a column with gaps has as `1.0` or `1,0`.
fn whole_number(text: &str) -> Option<i64> {
    let whole = text.split_once(['.', ',']).filter(|(_, rest)| rest.bytes().all(|b| b == b'0')).map_or(text, |(whole, _)| whole);
    whole.parse().ok()
}

/// What a file is that cannot be a table, by how it begins, and what to do.
fn other_than_table(bytes: &[u8]) -> Option<(&'static str, &'static str)> {
    const SAVE: &str = "save it as comma-separated text";
    const WRITE: &str = "write its labels as rows with the columns part and nyu40_id";
    let text = decoded_text(&bytes[..bytes.len().min(HEAD)]);
    let text = text.trim_start();
    let head: String = text.chars().take(PAGE.len()).collect::<String>().to_lowercase();
    let is_page = ["<html", "<head", "<body"].iter().any(|tag| head.starts_with(tag)) || head == PAGE;
    match bytes {
        [b'P', b'K', 3, 4, ..] => Some(("a spreadsheet or a ZIP archive", SAVE)),
        [0xd0, 0xcf, 0x11, 0xe0, ..] => Some(("a spreadsheet", SAVE)),
        [b'P', b'A', b'R', b'1', ..] => Some(("a Parquet file", SAVE)),
        [0x1f, 0x8b, ..] => Some(("packed by gzip", "unpack it")),
        _ if is_page => Some(("a page of the web", "download the table itself")),
        _ if text.starts_with('<') => Some(("XML", WRITE)),
        _ if text.starts_with('{') || text.starts_with("[{") || text.starts_with("[[") => Some(("JSON", WRITE)),
        _ => None,
    }
}

/// A table without the line `sep=;`, which names the separator for spreadsheets.
fn without_hint(text: &str) -> &str {
    let (first, rest) = text.split_once('\n').unwrap_or((text, ""));
    let is_hint = first.get(..4).is_some_and(|start| start.eq_ignore_ascii_case("sep=")) && first.trim_end().chars().count() <= 5;
    if is_hint { rest } else { text }
}

fn reader(bytes: &[u8], separator: u8) -> csv::Reader<&[u8]> {
    csv::ReaderBuilder::new().trim(csv::Trim::All).flexible(true).delimiter(separator).from_reader(bytes)
}

/// The separator with which the header has the columns of a table; where none fits, the comma.
fn separator(bytes: &[u8]) -> u8 {
    let fits = |separator: &u8| reader(bytes, *separator).headers().is_ok_and(|header| Columns::find(header, "").is_ok());
    SEPARATORS.into_iter().find(fits).unwrap_or(b',')
}

/// Number of line ends before the first text at or after `start`: the reader skips them silently.
fn blank_lines(bytes: &[u8], start: u64) -> u64 {
    let rest = bytes.get(start as usize..).unwrap_or(&[]);
    rest.iter().take_while(|b| matches!(b, b'\r' | b'\n')).filter(|&&b| b == b'\n').count() as u64
}

fn row_error(file: &str, line: u64, problem: String) -> TableError {
    TableError::Row { file: file.into(), line, problem }
}

fn csv_problem(error: &csv::Error) -> String {
    match error.kind() {
        csv::ErrorKind::Utf8 { .. } => "the text is not UTF-8; save the table as UTF-8".into(),
        _ => format!("not readable as CSV ({error}); save the table as comma-separated text"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(text: &str) -> String {
        LabelTable::parse(text.as_bytes(), "labels.csv").unwrap_err().to_string()
    }

    #[test]
    fn files_that_are_no_tables_are_told_by_what_they_are() {
        for (bytes, said) in [
            (&b"<!DOCTYPE html>\n<html><title>Login</title></html>"[..], "a page of the web, not a table (CSV); download the table itself"),
            (b"\xef\xbb\xbf  <HTML><body>", "a page of the web"),
            (b"<?xml version=\"1.0\"?><Error/>", "XML, not a table (CSV); write its labels as rows"),
            (b"{\"part\": \"sofa\"}", "JSON"),
            (b"[{\"part\": \"sofa\"}]", "JSON"),
            (b"PK\x03\x04\x14\0", "a spreadsheet or a ZIP archive, not a table (CSV); save it as comma-separated text"),
            (b"\xd0\xcf\x11\xe0\xa1\xb1", "a spreadsheet"),
            (b"PAR1\x15\x04", "a Parquet file"),
        ] {
            let error = LabelTable::parse(bytes, "labels.csv").unwrap_err().to_string();
            assert!(error.starts_with(&format!("labels.csv:1: the file is {said}")), "{error}");
        }
    }

    #[test]
    fn columns_are_found_by_name_and_others_ignored() {
        let text = "objects,nyu40_name,Material,scene,nyu40_id\n3,sofa,Leather,room,6\n1,,Glass,,-1\n";
        let table = LabelTable::parse(text.as_bytes(), "t").unwrap();
        let row = |line, scene: Option<&str>, name: &str, semantic| Row {
            line,
            scene: scene.map(Into::into),
            subject: Subject::Material,
            name: name.into(),
            semantic,
            instance: None,
        };
        assert_eq!(table.rows(), [row(2, Some("room"), "Leather", 6), row(3, None, "Glass", -1)]);
    }

    #[test]
    fn classes_may_be_names_and_instances_stated() {
        let table =
            LabelTable::parse(b"\xef\xbb\xbfname,semantic,instance\n\r\n\"a, b\",Otherprop,7\nc,4,-1\nd,,\ne,0,\nf,Night_stand,\n", "t")
                .unwrap();
        let found: Vec<_> = table.rows().iter().map(|r| (r.line, r.name.as_str(), r.semantic, r.instance)).collect();
        assert_eq!(found, [(3, "a, b", 40, Some(7)), (4, "c", 4, Some(-1)), (5, "d", -1, None), (6, "e", -1, None), (7, "f", 32, None)]);
    }

    #[test]
    fn tables_of_spreadsheets_are_read_whatever_separates_their_cells() {
        let comma = "part,nyu40_id,instance\nroom,1,\n\"a, b; c\",sofa,2\n";
        let expected = LabelTable::parse(comma.as_bytes(), "t").unwrap();
        let tabs = "part\tnyu40_id\tinstance\nroom\t1\t\na, b; c\tsofa\t2\n";
        let utf16 = |mark: [u8; 2], unit: fn(u16) -> [u8; 2]| [mark.to_vec(), tabs.encode_utf16().flat_map(unit).collect()].concat();
        for bytes in [
            b"part;nyu40_id;instance\r\nroom;1;\r\n\"a, b; c\";sofa;2\r\n".to_vec(),
            "\u{feff}part;nyu40_id;instance\nroom;1\n\"a, b; c\";sofa;2".into(),
            tabs.into(),
            utf16([0xff, 0xfe], u16::to_le_bytes),
            utf16([0xfe, 0xff], u16::to_be_bytes),
        ] {
            assert_eq!(LabelTable::parse(&bytes, "t"), Ok(expected.clone()), "{}", String::from_utf8_lossy(&bytes));
        }
    }

    #[test]
    fn numbers_with_points_and_rows_without_anything_are_what_pandas_and_spreadsheets_write() {
        let expected = LabelTable::parse(b"part,nyu40_id,instance\nroom,1,\nB\xc3\xbcro,14,2\nx,,\n", "t").unwrap();
        let same = |bytes: &[u8]| {
            let mut table = LabelTable::parse(bytes, "t").unwrap();
            table.rows.iter_mut().zip(expected.rows()).for_each(|(row, expected)| row.line = expected.line);
            assert_eq!(table, expected, "{}", String::from_utf8_lossy(bytes));
        };
        // pandas: DataFrame(...).to_csv() with a gap in a column of whole numbers, and with na_rep.
        same(",part,nyu40_id,instance\n0,room,1.0,\n1,Büro,14.0,2.0\n2,x,,\n".as_bytes());
        same("part,nyu40_id,instance\nroom,1.0,nan\nBüro,14.0,2.0\nx,NaN,NaN\n".as_bytes());
        same("sep=;\r\npart;NYU40 id;instance\r\nroom;1,0;\r\n;;\r\nBüro;14,00;2,0\r\nx;;\r\n;;\r\n".as_bytes());
        same("part,nyu40_id,instance,,\n\"\",,\nroom,1,,,\n,,,\n   \nBüro,14,2\nx,,\n,,".as_bytes());
        same(b"part,nyu40_id,instance\nroom,1,\nB\xfcro,14,2\nx,,\n");
        assert!(message("part,nyu40_id\na,5.5\n").contains(":2: unknown class \"5.5\""));
        assert!(message("part,nyu40_id,instance\na,5,1.5\n").contains(":2: instance \"1.5\" is no instance number"));
    }

    #[test]
    fn bad_tables_are_told_with_file_and_line() {
        let pointer = message("version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 9\n");
        assert!(pointer.starts_with("labels.csv:1: the file is a Git LFS pointer"), "{pointer}");
        assert_eq!(message("part,class\n"), "labels.csv:1: no column nyu40_id or semantic; the header has: part, class");
        assert_eq!(message("id,semantic\n"), "labels.csv:1: no column part, object, name or material; the header has: id, semantic");
        assert!(message("").starts_with("labels.csv:1: no column part"), "{}", message(""));
        assert!(message("part,semantic\na,5\nb,Divan\n").starts_with("labels.csv:3: unknown class \"Divan\"; expected a number"));
        for bad in ["41", "-2", "99999999999"] {
            assert!(message(&format!("part,nyu40_id\na,{bad}\n")).contains(&format!(":2: class {bad} is out of range")));
        }
        assert!(message("part,nyu40_id,instance\na,5,0\n").starts_with("labels.csv:2: instance \"0\" is no instance number"));
        assert!(message("part,nyu40_id\n,5\n").contains(":2: the row names nothing"));
        assert!(message("part,nyu40_id,nyu40_name\na,5,sofa\n").contains("class 5 is chair, but nyu40_name says \"sofa\""));
    }

    #[test]
    fn rows_that_disagree_are_refused_and_rows_that_agree_are_not() {
        assert_eq!(
            message("material,nyu40_id\nOak,7\nOak,14\n"),
            "labels.csv:3: \"Oak\" is 14 (desk) here but 7 (table) in line 2; remove one of the rows"
        );
        assert!(LabelTable::parse(b"material,nyu40_id\nOak,7\nOak,7\n", "t").is_ok());
        assert!(LabelTable::parse(b"scene,material,nyu40_id\na,Oak,7\nb,Oak,14\n", "t").is_ok());
    }
}
