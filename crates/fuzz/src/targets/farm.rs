//! Files in the store of a farm: written by other machines, read by each worker and by whoever asks for the status.

use crate::{Run, Seed};
use enfilade_farm::{Job, Plan, Store, costs, status, unpack};
use std::path::Path;

const PLAN: &str = r#"{"format":1,"program":"enfilade 0","id":"0","dataset":"d","cpus":2,
"files":{"_detail/x.csv":{"blake3":"00000000000000000000000000000000000000000000000000000000000000aa","bytes":3}},
"scenes":[{"name":"room","files":{},"frames":2,"cpu_s":{"mean":2,"deviation":1},"memory_bytes":{"mean":2,"deviation":1},"disk_bytes":{"mean":2,"deviation":1}}],
"tasks":[{"scene":"room","camera":"cam_00","frames":[0,1],"cpu_s":1.5}]}"#;
const MARKER: &str = r#"{"scene":"room","camera":"cam_00","frame":0,"payload":"frames/room/cam_00/0000.a.tar","bytes":5,
"blake3":"00","attempt":"a","task":0,"broken":["a law"],"wall_s":1.5,"cpu_s":2.5,"peak_memory_bytes":7,"threads":2}"#;
const RECORD: &str = r#"{"id":"a","host":"n","engine":{"SLURM_JOB_ID":"1"},"task":0,"wall_s":1.5,"cpu_s":2.5,"threads":2,"peak_memory_bytes":7,
"committed":1,"lost":0,"different":0,"ended":"transient","error":"full"}"#;

/// Reads the bytes as a plan, and where they are one, as the plan of a job; as a marker and a record of a job that is at work; and as the
/// archive of a frame.
pub fn job(folder: &Path) -> Run {
    let (place, out) = (folder.join("job"), folder.join("out"));
    let store = Store::begin(place.to_str().expect("a folder with a name in Unicode"), std::iter::empty()).expect("a folder");
    let mut job = Job { store, plan: Plan::from_json(PLAN.as_bytes()).expect("a plan") };
    for folder in ["attempts", "done/room/cam_00"] {
        std::fs::create_dir_all(place.join(folder)).expect("a folder that can be written");
    }
    Box::new(move |bytes| {
        if let Ok(plan) = Plan::from_json(bytes) {
            let own = std::mem::replace(&mut job.plan, plan);
            look(&job);
            job.plan = own;
        }
        for file in ["attempts/000000.a.json", "done/room/cam_00/0000.json"].map(|name| place.join(name)) {
            std::fs::write(&file, bytes).expect("a folder that can be written");
            look(&job);
            std::fs::remove_file(&file).expect("a folder that can be written");
        }
        drop(unpack(bytes, &out, "frame.tar"));
        drop(std::fs::remove_dir_all(&out));
    })
}

fn look(job: &Job) {
    drop(status(job));
    if let Ok(costs) = costs(job) {
        drop(costs.table(job, &[]));
    }
}

/// A plan, a marker, a record, and an archive.
pub fn seeds() -> Vec<Seed> {
    let text = |name: &str, text: &str| Seed { name: name.into(), bytes: text.into() };
    vec![text("plan", PLAN), text("marker", MARKER), text("record", RECORD), Seed { name: "frame.tar".into(), bytes: archive() }]
}

/// A file `a` that holds `hello`, as tar of 1988.
fn archive() -> Vec<u8> {
    let mut head = [0; 512];
    let mut put = |at: usize, text: &[u8]| head[at..at + text.len()].copy_from_slice(text);
    put(0, b"a");
    put(100, b"0000644\0");
    put(124, b"00000000005\0");
    put(136, b"00000000000\0");
    put(148, b"        ");
    put(156, b"0");
    put(257, b"ustar\x0000");
    let sum: u32 = head.iter().map(|&byte| u32::from(byte)).sum();
    head[148..156].copy_from_slice(format!("{sum:06o}\0 ").as_bytes());
    [&head[..], b"hello", &[0; 507], &[0; 1024]].concat()
}
