//! The machine that a benchmark was run on, by the name of its processor.

/// The name of the processor, if the system reports it: for the pages of benchmarks.
pub fn processor() -> String {
    let about = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let field = |name: &str| about.lines().find_map(|line| line.strip_prefix(name)?.split_once(':').map(|(_, value)| value.trim()));
    let name = field("model name").unwrap_or("an unknown processor");
    field("cpu family").map_or(name.into(), |family| format!("{name} (family {family})"))
}
