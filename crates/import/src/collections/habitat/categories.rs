//! Categories of objects, by the tables of a dataset.

use super::super::assets::unless_odd;
use super::super::json;
use super::super::listed::Listed;
use super::dataset::Dataset;
use crate::ImportError;
use crate::assembly::Assembly;
use enfilade_scene::decoded_text;
use serde::Deserialize;
use std::collections::HashMap;

/// HSSD's table of its models.
const TABLE: &str = "semantics/objects.csv";

/// Categories by model and by semantic number.
#[derive(Default)]
pub(super) struct Categories {
    by_model: HashMap<String, String>,
    by_number: HashMap<i64, String>,
}

#[derive(Deserialize)]
struct Lexicon {
    classes: Listed<Class>,
}

#[derive(Deserialize)]
struct Class {
    id: i64,
    name: String,
}

impl Categories {
    /// Reads the categories of a dataset; `wanted` is the handle of the lexicon that the scene names.
    ///
    /// # Errors
    /// When a table that is there cannot be read.
    pub fn read(dataset: &Dataset, wanted: Option<&str>, a: &mut Assembly) -> Result<Self, ImportError> {
        let by_model = Self::table(dataset, a);
        let by_model = unless_odd(by_model, "categories", "a table", a)?.unwrap_or_default();
        let named = wanted.and_then(|handle| dataset.semantics.get(handle));
        let files = named.into_iter().chain(dataset.semantics.values()).filter(|file| file.ends_with(".json"));
        for file in files.map(|file| dataset.root.join(file)) {
            if !file.is_file() {
                a.note_missing(&file);
                continue;
            }
            let bytes = a.read_input(&file, "check the permission to read it")?;
            let lexicon = json::parse::<Lexicon>(&bytes, &file, "a lexicon, {\"classes\": [{\"id\", \"name\"}]}");
            let Some(lexicon) = unless_odd(lexicon, "categories", "a lexicon", a)? else { continue };
            lexicon.classes.report(&file.display().to_string(), a);
            let by_number = lexicon.classes.iter().map(|class| (class.id, class.name.clone())).collect();
            return Ok(Self { by_model, by_number });
        }
        Ok(Self { by_model, by_number: HashMap::new() })
    }

    fn table(dataset: &Dataset, a: &mut Assembly) -> Result<HashMap<String, String>, ImportError> {
        let file = dataset.root.join(TABLE);
        if !file.is_file() {
            a.note_missing(&file);
            return Ok(HashMap::new());
        }
        let bytes = a.read_input(&file, "check the permission to read it")?;
        let text = decoded_text(&bytes);
        let mut reader = csv::ReaderBuilder::new().flexible(true).from_reader(text.as_bytes());
        let malformed = |line: u64, problem: String| ImportError::malformed(&file, format!("line {line}"), problem);
        let header = reader.headers().map_err(|e| malformed(1, format!("it is no CSV ({e}); unpack the dataset again")))?.clone();
        let column = |name: &str| header.iter().position(|h| h.trim().eq_ignore_ascii_case(name));
        let Some(id) = column("id") else { return Err(malformed(1, "found no column id; unpack the dataset again".into())) };
        let (main, key) = (column("main_category"), column("wnsynsetkey"));
        let mut categories = HashMap::new();
        for record in reader.records() {
            let record = record.map_err(|e| {
                let line = e.position().map_or(1, csv::Position::line);
                malformed(line, format!("it is no row of CSV ({e}); unpack the dataset again"))
            })?;
            let cell = |column: Option<usize>| column.and_then(|c| record.get(c)).map(str::trim).filter(|text| !text.is_empty());
            // A key of WordNet, such as armchair.n.01.
            let noun = || cell(key)?.split('.').next();
            if let (Some(id), Some(category)) = (cell(Some(id)), cell(main).or_else(noun)) {
                categories.insert(id.to_string(), category.to_string());
            }
        }
        Ok(categories)
    }

    /// The category of a model, by its name or else its semantic number. Parts of decomposed models (`<model>_part_<n>`) are what the
    /// model is.
    pub fn of(&self, template: &str, semantic_id: Option<i64>) -> Option<&str> {
        let name = template.rsplit('/').next().unwrap_or(template);
        let whole = name.split("_part_").next().unwrap_or(name);
        let by_model = self.by_model.get(name).or_else(|| self.by_model.get(whole));
        let by_number = || self.by_number.get(&semantic_id.filter(|id| *id > 0)?);
        by_model.or_else(by_number).map(String::as_str)
    }
}
