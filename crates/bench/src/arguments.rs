//! The words of the command line.

/// The words behind the instrument's name.
pub fn arguments() -> impl Iterator<Item = String> {
    std::env::args().skip(2)
}

/// The building of this name; a home unless one is named.
pub fn building(name: Option<&str>) -> std::io::Result<enfilade_home::Building> {
    let Some(name) = name else { return Ok(enfilade_home::Building::Home) };
    let known = enfilade_home::Building::ALL;
    known.into_iter().find(|building| building.name() == name).ok_or_else(|| {
        let names = known.map(enfilade_home::Building::name).join(", ");
        std::io::Error::other(format!("--building is {name:?}, expected one of {names}"))
    })
}
