//! The dependency policy: the crates that a build may contain.
//!
//! It covers everything that ends up in a program or runs while it is built, on every platform, but not crates that only tests use. The
//! allowed licences are read from `deny.toml`, so that `cargo deny` and this check agree.

use crate::house::House;
use crate::step::finish;
use crate::{floors, spdx};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// Name in the metadata of the one registry that crates may come from.
const CRATES_IO: &str = "registry+https://github.com/rust-lang/crates.io-index";

/// Checks licences, sources and the place of versions; runs `cargo deny` too where it is installed.
///
/// # Errors
/// With every crate that breaks the policy.
pub fn check(house: &House) -> Result<String, String> {
    let policy = Policy::read(&house.read("deny.toml")?)?;
    let metadata = house.metadata(&[])?;
    let built = built(&metadata);
    let mut found: Vec<String> = built.iter().filter_map(|package| wrong(package, &policy)).collect();
    for (name, manifest) in floors::manifests(house)? {
        found.extend(own_versions(&name, &manifest));
    }
    if !found.is_empty() {
        return Err(found.join("\n  "));
    }
    let remark = format!("{} crates from outside", built.iter().filter(|package| !package["source"].is_null()).count());
    if !house.has_cargo_command("deny") {
        return Ok(format!("{remark}; security advisories not looked up (`cargo install cargo-deny` does)"));
    }
    finish(house.cargo(&["deny", "check"])).map(|_| remark)
}

/// The licences that `deny.toml` allows.
struct Policy {
    /// For every crate.
    allowed: Vec<String>,
    /// For single crates besides.
    exceptions: BTreeMap<String, Vec<String>>,
}

impl Policy {
    fn read(deny: &str) -> Result<Self, String> {
        let table: toml::Table = deny.parse().map_err(|error| format!("deny.toml: {error}"))?;
        let licenses = table.get("licenses").ok_or("deny.toml: expected a section [licenses]")?;
        let list = |of: &toml::Value| {
            let list = of.get("allow").and_then(toml::Value::as_array);
            let list = list.ok_or("deny.toml: expected a list `allow` in [licenses] and in each of its exceptions")?;
            Ok::<_, String>(list.iter().filter_map(toml::Value::as_str).map(str::to_string).collect::<Vec<_>>())
        };
        let exceptions = licenses.get("exceptions").and_then(toml::Value::as_array).into_iter().flatten();
        let exceptions = exceptions.map(|exception| {
            let name = exception.get("crate").and_then(toml::Value::as_str);
            Ok((name.ok_or("deny.toml: expected the name of a `crate` in each exception of [licenses]")?.to_string(), list(exception)?))
        });
        Ok(Self { allowed: list(licenses)?, exceptions: exceptions.collect::<Result<_, String>>()? })
    }

    /// The licences that a crate may have.
    fn of(&self, name: &str) -> Vec<String> {
        self.allowed.iter().chain(self.exceptions.get(name).into_iter().flatten()).cloned().collect()
    }
}

/// The packages that the workspace needs to be built, itself included.
fn built(metadata: &Value) -> Vec<&Value> {
    let list = |value: &'static str, of: &'_ Value| of[value].as_array().cloned().unwrap_or_default();
    let mut needs: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for node in list("nodes", &metadata["resolve"]) {
        let real = |dependency: &Value| list("dep_kinds", dependency).iter().any(|kind| kind["kind"] != "dev");
        let dependencies = list("deps", &node).into_iter().filter(real).map(|dependency| id(&dependency["pkg"])).collect();
        needs.insert(id(&node["id"]), dependencies);
    }
    let mut open: Vec<String> = list("workspace_members", metadata).iter().map(id).collect();
    let mut reached = BTreeSet::new();
    while let Some(package) = open.pop() {
        if reached.insert(package.clone()) {
            open.extend(needs.get(&package).cloned().unwrap_or_default());
        }
    }
    metadata["packages"].as_array().into_iter().flatten().filter(|package| reached.contains(&id(&package["id"]))).collect()
}

fn id(value: &Value) -> String {
    value.as_str().unwrap_or_default().to_string()
}

/// The problem of a package, if any.
fn wrong(package: &Value, policy: &Policy) -> Option<String> {
    let text = |key: &str| package[key].as_str();
    let name = format!("{} {}", text("name").unwrap_or("?"), text("version").unwrap_or("?"));
    if let Some(source) = text("source").filter(|source| *source != CRATES_IO) {
        return Some(format!("{name} comes from {source}; expected crates.io"));
    }
    let Some(licence) = text("license") else { return Some(format!("{name} states no licence expression")) };
    match spdx::satisfied(licence, &policy.of(text("name").unwrap_or_default())) {
        Ok(true) => None,
        Ok(false) => Some(format!("{name} has the licence {licence}, which deny.toml does not allow")),
        Err(message) => Some(format!("{name}: {message}")),
    }
}

/// The dependencies of a crate that do not take their version from the workspace's one table.
fn own_versions(name: &str, manifest: &toml::Table) -> Vec<String> {
    let kinds = ["dependencies", "dev-dependencies", "build-dependencies"];
    let inherited = |value: &toml::Value| value.get("workspace").and_then(toml::Value::as_bool) == Some(true);
    let own = floors::listed(manifest, &kinds).filter(|(_, value)| !inherited(value));
    own.map(|(key, _)| {
        format!("crate `{name}`: {key} has a version of its own; write `{key}.workspace = true`, and the version in Cargo.toml at the root")
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn package(name: &str, source: Option<&str>, license: Option<&str>) -> Value {
        json!({ "id": name, "name": name, "version": "1.0.0", "source": source, "license": license })
    }

    #[test]
    fn what_only_tests_use_is_not_counted() {
        let edge = |package: &str, kind: Value| json!({ "pkg": package, "dep_kinds": [{ "kind": kind }] });
        let packages = ["own", "a", "b", "c"].map(|name| package(name, Some(CRATES_IO), Some("MIT")));
        let metadata = json!({
            "workspace_members": ["own"],
            "resolve": { "nodes": [
                { "id": "own", "deps": [edge("a", Value::Null), edge("b", "dev".into())] },
                { "id": "a", "deps": [edge("c", "build".into())] },
                { "id": "b", "deps": [] },
                { "id": "c", "deps": [] },
            ] },
            "packages": packages,
        });
        assert_eq!(built(&metadata).iter().map(|p| id(&p["name"])).collect::<Vec<_>>(), ["own", "a", "c"]);
    }

    #[test]
    fn a_strange_source_a_missing_and_a_foreign_licence_are_found() {
        let allowed = Policy { allowed: vec!["MIT".to_string()], exceptions: BTreeMap::new() };
        assert_eq!(wrong(&package("a", Some(CRATES_IO), Some("MIT OR GPL-3.0-only")), &allowed), None);
        assert_eq!(wrong(&package("own", None, Some("MIT")), &allowed), None);
        let fork = wrong(&package("a", Some("git+https://example.org/a"), Some("MIT")), &allowed).unwrap();
        assert_eq!(fork, "a 1.0.0 comes from git+https://example.org/a; expected crates.io");
        assert!(wrong(&package("a", Some(CRATES_IO), None), &allowed).unwrap().contains("no licence expression"));
        assert!(wrong(&package("a", Some(CRATES_IO), Some("GPL-3.0-only")), &allowed).unwrap().contains("GPL-3.0-only"));
    }

    #[test]
    fn an_exception_is_for_its_crate_alone() {
        let deny = "[licenses]\nallow = [\"MIT\"]\n[[licenses.exceptions]]\ncrate = \"tables\"\nallow = [\"CC-BY-SA-3.0\"]";
        let policy = Policy::read(deny).unwrap();
        assert_eq!(wrong(&package("tables", None, Some("MIT AND CC-BY-SA-3.0")), &policy), None);
        let other = wrong(&package("other", None, Some("MIT AND CC-BY-SA-3.0")), &policy).unwrap();
        assert!(other.contains("which deny.toml does not allow"), "{other}");
    }

    #[test]
    fn versions_outside_of_the_workspace_table_are_found() {
        let manifest = "[dependencies]\nglam.workspace = true\nserde_json = { workspace = true, features = [\"float_roundtrip\"] }\n\
            [dev-dependencies]\ncsv = \"1\"\n[target.'cfg(unix)'.dependencies]\nrustix = { version = \"1\" }";
        let found = own_versions("math", &manifest.parse().unwrap());
        assert_eq!(found.len(), 2);
        assert!(found[0].starts_with("crate `math`: csv has a version of its own"), "{}", found[0]);
    }

    #[test]
    fn the_list_of_licences_is_read_from_deny_toml() {
        let policy = Policy::read(&House::find().unwrap().read("deny.toml").unwrap()).unwrap();
        assert!(policy.allowed.contains(&"MIT".to_string()) && !policy.allowed.iter().any(|licence| licence.contains("GPL")));
        assert!(Policy::read("[bans]").err().unwrap().contains("[licenses]"));
        assert!(Policy::read("[licenses]\nallow = []\n[[licenses.exceptions]]\nallow = []").err().unwrap().contains("`crate`"));
    }
}
