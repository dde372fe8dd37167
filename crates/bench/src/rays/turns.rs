//! The engines trace the same rays in turns.

use super::cases::{Case, Question, Room, cases};
use super::peers::{Failure, Peers};
use enfilade_geometry::Bvh;
use enfilade_math::Ray;
use enfilade_testkit::thread_cpu_s;

/// Odd, so that there is a median.
const TURNS: usize = 9;

/// The results of one engine, to be compared with the others'.
#[derive(Clone, Copy, Default, PartialEq)]
pub struct Answers {
    pub hits: usize,
    /// Sum of the parameters of the first hits.
    pub sum_of_t: f64,
}

/// One engine on one kind of rays.
#[derive(Clone, Default)]
pub struct Measured {
    pub seconds: f64,
    pub answers: Answers,
}

/// One kind of rays in one room. The engines are ours, Embree, Embree robust; or ours alone.
pub struct Row {
    pub case: &'static str,
    pub rays: usize,
    pub engines: Vec<Measured>,
}

/// A room's rows.
pub struct Compared {
    pub room: String,
    pub triangles: usize,
    pub build_seconds: f64,
    pub megabytes: f64,
    pub rows: Vec<Row>,
}

/// Measures a room.
pub fn compare(room: &Room, peers: &Peers) -> Result<Compared, Failure> {
    let (build_seconds, bvh) = timed(|| Bvh::new(&room.triangles, &|_| false));
    let megabytes = bvh.memory_bytes() as f64 / 1e6;
    println!("\n{}: {} triangles, built in {build_seconds:.2} core-s, {megabytes:.1} MB", room.name, room.triangles.len());
    let engines = engines(room, &bvh, peers);
    let mut rows = Vec::new();
    for case in cases(room, &bvh) {
        let row = measure(&case, &engines);
        print(&row);
        agree(&room.name, &row)?;
        rows.push(row);
    }
    Ok(Compared { room: room.name.clone(), triangles: room.triangles.len(), build_seconds, megabytes, rows })
}

type Trace<'a> = Box<dyn Fn(&[Ray], Question) -> Answers + 'a>;

fn engines<'a>(room: &Room, bvh: &'a Bvh, peers: &Peers) -> Vec<Trace<'a>> {
    let ours = |rays: &[Ray], question| trace(rays, question, |ray| bvh.closest(ray).map(|hit| hit.t), |ray| bvh.occluded(ray));
    let mut engines: Vec<Trace> = vec![Box::new(ours)];
    #[cfg(unix)]
    if let Some(library) = peers.embree {
        for robust in [false, true] {
            let embree = super::embree::Embree::new(library, &room.triangles, robust);
            engines.push(Box::new(move |rays: &[Ray], question| {
                trace(rays, question, |ray| embree.closest(ray).map(|hit| hit.0), |ray| embree.occluded(ray))
            }));
        }
    }
    engines
}

#[inline(always)]
fn trace(rays: &[Ray], question: Question, closest: impl Fn(&Ray) -> Option<f32>, any: impl Fn(&Ray) -> bool) -> Answers {
    let mut answers = Answers::default();
    match question {
        Question::Closest => {
            for t in rays.iter().filter_map(closest) {
                answers.hits += 1;
                answers.sum_of_t += f64::from(t);
            }
        }
        Question::Any => answers.hits = rays.iter().filter(|ray| any(ray)).count(),
    }
    answers
}

fn measure(case: &Case, engines: &[Trace]) -> Row {
    let mut seconds = vec![Vec::new(); engines.len()];
    let mut answers = vec![Answers::default(); engines.len()];
    for _ in 0..TURNS {
        for (i, engine) in engines.iter().enumerate() {
            let (time, found) = timed(|| engine(&case.rays, case.question));
            seconds[i].push(time);
            answers[i] = found;
        }
    }
    let measured = |(mut seconds, answers): (Vec<f64>, Answers)| {
        seconds.sort_by(f64::total_cmp);
        Measured { seconds: seconds[TURNS / 2], answers }
    };
    Row { case: case.name, rays: case.rays.len(), engines: std::iter::zip(seconds, answers).map(measured).collect() }
}

impl Row {
    /// Millions of rays per core-second of an engine.
    pub fn speed(&self, engine: usize) -> f64 {
        self.rays as f64 / self.engines[engine].seconds / 1e6
    }
}

fn print(row: &Row) {
    let speeds: Vec<String> = (0..row.engines.len()).map(|i| format!("{:6.2}", row.speed(i))).collect();
    let ratios: Vec<String> = (1..row.engines.len()).map(|i| format!("{:.2}", row.speed(0) / row.speed(i))).collect();
    let ours = row.engines[0].answers;
    println!("{:>24}  {}  Mrays/core-s   {}   {} hits{}", row.case, speeds.join(" "), ratios.join(" "), ours.hits, differences(row));
}

/// The differences between the others' answers and ours.
fn differences(row: &Row) -> String {
    let ours = row.engines[0].answers;
    let other = |engine: &Measured| {
        let hits = engine.answers.hits as i64 - ours.hits as i64;
        let sum = engine.answers.sum_of_t / ours.sum_of_t - 1.0;
        if ours.sum_of_t == 0.0 { format!(", {hits:+}") } else { format!(", {hits:+} (sum of t {sum:+.0e})") }
    };
    row.engines[1..].iter().map(other).collect()
}

/// Checks that the engines found the same, except for single rays along edges, which may go on to something far away.
fn agree(room: &str, row: &Row) -> Result<(), Failure> {
    const ODD_RAYS: f64 = 1e-4;
    const ODD_SUM: f64 = 1e-3;
    let ours = row.engines[0].answers;
    for other in row.engines[1..].iter().map(|engine| engine.answers) {
        let odd_hits = ours.hits.abs_diff(other.hits) as f64 / row.rays as f64;
        let odd_t = (ours.sum_of_t - other.sum_of_t).abs() / ours.sum_of_t.max(1.0);
        if odd_hits > ODD_RAYS || odd_t > ODD_SUM {
            let found = |a: Answers| format!("{} hits at {} in sum", a.hits, a.sum_of_t);
            return Err(format!("{room}, {}: ours found {}, Embree {}", row.case, found(ours), found(other)).into());
        }
    }
    Ok(())
}

/// Processor seconds of this thread, and the result.
fn timed<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let start = thread_cpu_s();
    let result = work();
    (thread_cpu_s() - start, result)
}
