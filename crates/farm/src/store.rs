//! The store that decides what is done: a folder that all nodes see, or a bucket of S3, Google Cloud Storage or Azure.
//!
//! Little is asked of it: objects appear whole, and of several writers of one name with [`Store::create`] exactly one succeeds.
//! [`Store::probe`] finds out whether it keeps to that.

use crate::FarmError;
use crate::error::START_THREADS;
use crate::object_names::{ALL, PLAN, PROBE};
use futures_util::TryStreamExt;
use object_store::local::LocalFileSystem;
use object_store::path::Path as Key;
use object_store::{Error as StoreError, ObjectStore, ObjectStoreExt, PutMode, PutOptions, PutPayload};
use std::path::Path;
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::Duration;
use tokio::runtime::Runtime;

/// Most attempts at a request that fails for a transient reason.
const ATTEMPTS: u32 = 5;
/// Before the second attempt; doubled before each further one.
const FIRST_PAUSE: Duration = Duration::from_millis(100);
/// Prefixes of the variables that are settings of a store. The library also takes bare names such as `TOKEN` or `ENDPOINT`, but these
/// may belong to any program.
const PREFIXES: [&str; 3] = ["aws_", "azure_", "google_"];
/// Longest duration of one request to a bucket, its whole body included, unless `AWS_TIMEOUT` or a similar variable sets another: scenes
/// are large.
const REQUEST_TIMEOUT: &str = "900s";
/// Writers at once, and rounds, when a store is probed.
const PROBE_WRITERS: usize = 16;
const PROBE_ROUNDS: usize = 4;

/// A place for objects by name, with `/` between the parts of names.
#[derive(Debug)]
pub struct Store {
    inner: Arc<dyn ObjectStore>,
    root: Key,
    url: String,
    runtime: Runtime,
}

/// The result of creating an object that only one attempt may write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Created {
    /// The object is there now, as given.
    Yes,
    /// The name is taken: by somebody else, or by an earlier try whose answer was lost.
    Taken,
}

/// Threads that requests go on with; files are read and written by one more.
const WORKERS: usize = 2;
/// The size of a thread's stack, bytes: what the runtime gives its own.
const STACK: usize = 2 << 20;

/// The runtime that requests run in. It would abort this process if the system gave it no threads, so we ask for them first.
fn runtime() -> std::io::Result<Runtime> {
    ask_for_threads(WORKERS + 1, STACK)?;
    tokio::runtime::Builder::new_multi_thread().worker_threads(WORKERS).thread_stack_size(STACK).enable_all().build()
}

/// Tests whether the system can start `count` threads at once, by starting and ending them.
fn ask_for_threads(count: usize, stack: usize) -> std::io::Result<()> {
    // All of them wait until this is dropped, so that none makes room for another.
    let (hold, held) = std::sync::mpsc::channel::<()>();
    let held = Arc::new(Mutex::new(held));
    let start = |_| {
        let held = held.clone();
        let wait = move || drop(held.lock().map(|held| held.recv()));
        std::thread::Builder::new().stack_size(stack).spawn(wait)
    };
    let started: Vec<std::io::Result<JoinHandle<()>>> = (0..count).map(start).collect();
    drop(hold);
    let ended = started.into_iter().map(|thread| thread.map(|thread| drop(thread.join())));
    ended.collect::<Vec<_>>().into_iter().collect()
}

/// The variables of this process that are text.
pub fn environment() -> impl Iterator<Item = (String, String)> {
    std::env::vars_os().filter_map(|(name, value)| Some((name.into_string().ok()?, value.into_string().ok()?)))
}

/// The local folder that a place names.
fn local(place: &str) -> Option<&Path> {
    match place.split_once("://") {
        None => Some(Path::new(place)),
        Some(("file", path)) => Some(Path::new(path)),
        Some(_) => None,
    }
}

/// Refuses a folder that has something else than a job, or the beginning of one.
fn refuse_foreign_folder(folder: &Path) -> Result<(), FarmError> {
    if folder.is_symlink() && !folder.exists() {
        let problem = "is a broken link; create its target folder, or name another one";
        return Err(FarmError::Request(format!("{} {problem}", folder.display())));
    }
    let Ok(entries) = std::fs::read_dir(folder) else { return Ok(()) };
    let names: Vec<String> = entries.filter_map(Result::ok).map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    let foreign = names.iter().find(|name| !name.starts_with('.') && !ALL.contains(&name.as_str()));
    match foreign {
        Some(name) if !names.iter().any(|name| name == PLAN) => Err(FarmError::Request(format!(
            "{} holds something else (among it {name:?}), and no job; name an empty folder or one that does not exist yet",
            folder.display()
        ))),
        _ => Ok(()),
    }
}

impl Store {
    /// The store at `place` for a new job: a folder is made if need be, and must not contain anything else.
    ///
    /// # Errors
    /// As [`Store::open`], and when the folder contains something else or cannot be made.
    pub fn begin(place: &str, settings: impl Iterator<Item = (String, String)>) -> Result<Self, FarmError> {
        if let Some(folder) = local(place) {
            refuse_foreign_folder(folder)?;
            std::fs::create_dir_all(folder).map_err(|source| FarmError::io("make the folder", folder, source))?;
        }
        Self::open(place, settings)
    }

    /// The store at `place`: a folder, or a URL: `file://`, `s3://bucket/prefix`, `gs://`, `az://`. Keys,
    /// regions and endpoints are taken from `settings`, usually the [`environment`], under the names that these services use
    /// (`AWS_ACCESS_KEY_ID`, `AWS_ENDPOINT_URL`, `GOOGLE_APPLICATION_CREDENTIALS`, `AZURE_STORAGE_ACCOUNT_NAME`, …). Others are left.
    ///
    /// # Errors
    /// When the place cannot be understood, or is a folder that is not there, and when the system gives no threads.
    pub fn open(place: &str, settings: impl Iterator<Item = (String, String)>) -> Result<Self, FarmError> {
        let runtime = runtime().map_err(|source| FarmError::io(START_THREADS, Path::new(place), source))?;
        if let Some(folder) = local(place) {
            if !folder.is_dir() {
                let what = if folder.exists() { "is no folder" } else { "does not exist" };
                return Err(FarmError::Request(format!("{place} {what}; plan a job: enfilade farm plan dataset.toml -o JOB")));
            }
            let absolute = std::fs::canonicalize(folder).map_err(|source| FarmError::io("find", folder, source))?;
            let inner = LocalFileSystem::new_with_prefix(&absolute).map_err(FarmError::store(place))?.with_fsync(true);
            return Ok(Self { inner: Arc::new(inner), root: Key::default(), url: absolute.display().to_string(), runtime });
        }
        // Another provider, if the program has set one, is as good.
        let _ = rustls::crypto::ring::default_provider().install_default();
        let url = url::Url::parse(place).map_err(|error| FarmError::Place { place: place.into(), problem: error.to_string() })?;
        let settings = settings.map(|(name, value)| (name.to_ascii_lowercase(), value));
        let settings = settings.filter(|(name, _)| PREFIXES.iter().any(|prefix| name.starts_with(prefix)));
        let settings = std::iter::once(("timeout".to_string(), REQUEST_TIMEOUT.to_string())).chain(settings);
        let unknown = |error: StoreError| FarmError::Place { place: place.into(), problem: error.to_string() };
        let (inner, root) = object_store::parse_url_opts(&url, settings).map_err(unknown)?;
        Ok(Self { inner: Arc::from(inner), root, url: place.trim_end_matches('/').into(), runtime })
    }

    /// The place as it was given; of a folder its absolute path.
    pub fn url(&self) -> &str {
        &self.url
    }

    /// Writes an object, in place of an older one.
    ///
    /// # Errors
    /// When the store cannot take it.
    pub fn put(&self, name: &str, bytes: Vec<u8>) -> Result<(), FarmError> {
        let (key, payload) = (self.key(name), PutPayload::from(bytes));
        self.again(|| self.inner.put(&key, payload.clone())).map(drop).map_err(|error| self.failed(name, error))
    }

    /// Writes an object of whose writers only one may succeed.
    ///
    /// [`Created::Taken`] may come from an own earlier try whose answer was lost: read the object to learn whose it is.
    ///
    /// # Errors
    /// When the store cannot take it.
    pub fn create(&self, name: &str, bytes: &[u8]) -> Result<Created, FarmError> {
        let (key, payload) = (self.key(name), PutPayload::from(bytes.to_vec()));
        let options = || PutOptions { mode: PutMode::Create, ..PutOptions::default() };
        match self.again(|| self.inner.put_opts(&key, payload.clone(), options())) {
            Ok(_) => Ok(Created::Yes),
            Err(StoreError::AlreadyExists { .. } | StoreError::Precondition { .. }) => Ok(Created::Taken),
            Err(error) => Err(self.failed(name, error)),
        }
    }

    /// An object's bytes; `None` when there is none of that name.
    ///
    /// # Errors
    /// When the store does not answer.
    pub fn get(&self, name: &str) -> Result<Option<Vec<u8>>, FarmError> {
        let read = || async { self.inner.get(&self.key(name)).await?.bytes().await };
        match self.again(read) {
            Ok(bytes) => Ok(Some(bytes.to_vec())),
            Err(StoreError::NotFound { .. }) => Ok(None),
            Err(error) => Err(self.failed(name, error)),
        }
    }

    /// An object's length in bytes; `None` when there is none of that name.
    ///
    /// # Errors
    /// When the store does not answer.
    pub fn size(&self, name: &str) -> Result<Option<u64>, FarmError> {
        let key = self.key(name);
        match self.again(|| self.inner.head(&key)) {
            Ok(meta) => Ok(Some(meta.size)),
            Err(StoreError::NotFound { .. }) => Ok(None),
            Err(error) => Err(self.failed(name, error)),
        }
    }

    /// Removes an object, if it is there.
    ///
    /// # Errors
    /// When the store does not answer.
    pub fn remove(&self, name: &str) -> Result<(), FarmError> {
        let key = self.key(name);
        match self.again(|| self.inner.delete(&key)) {
            Ok(()) | Err(StoreError::NotFound { .. }) => Ok(()),
            Err(error) => Err(self.failed(name, error)),
        }
    }

    /// The names of all objects below `folder`, with their sizes in bytes, in the order of names.
    ///
    /// # Errors
    /// When the store does not answer.
    pub fn list(&self, folder: &str) -> Result<Vec<(String, u64)>, FarmError> {
        let prefix = self.key(folder);
        let read = || async { self.inner.list(Some(&prefix)).try_collect::<Vec<_>>().await };
        let found = self.again(read).map_err(|error| self.failed(folder, error))?;
        let name = |key: &Key| {
            let parts = key.prefix_match(&self.root)?;
            Some(parts.map(|part| part.as_ref().to_string()).collect::<Vec<_>>().join("/"))
        };
        let mut names: Vec<(String, u64)> = found.iter().filter_map(|meta| Some((name(&meta.location)?, meta.size))).collect();
        names.sort();
        Ok(names)
    }

    /// Finds out whether of several writers of one name exactly one succeeds: on that every commit rests.
    ///
    /// # Errors
    /// When it is not so, or the store cannot be written.
    pub fn probe(&self, unique: &str) -> Result<(), FarmError> {
        for round in 0..PROBE_ROUNDS {
            let name = format!("{PROBE}/{unique}-{round}");
            let won = std::thread::scope(|scope| -> Result<usize, FarmError> {
                let writers: Vec<_> = (0..PROBE_WRITERS)
                    .map(|i| {
                        scope.spawn({
                            let name = &name;
                            move || self.create(name, format!("{i}").as_bytes())
                        })
                    })
                    .collect();
                let mut won = 0;
                for writer in writers {
                    let created = writer
                        .join()
                        .map_err(|_| FarmError::Unreliable { place: self.url.clone(), problem: "a writer panicked".into() })??;
                    won += usize::from(created == Created::Yes);
                }
                Ok(won)
            });
            let again = self.create(&name, b"again");
            self.remove(&name)?;
            let (won, again) = (won?, again?);
            if won != 1 || again == Created::Yes {
                let later = if again == Created::Yes { "so was a later one" } else { "a later one was refused" };
                let problem = format!("{won} of {PROBE_WRITERS} writers of one new object were told that they created it, and {later}");
                return Err(FarmError::Unreliable { place: self.url.clone(), problem });
            }
        }
        Ok(())
    }

    /// An object's name with the place, for messages.
    pub(crate) fn full_name(&self, name: &str) -> String {
        format!("{}/{name}", self.url)
    }

    fn failed(&self, name: &str, error: StoreError) -> FarmError {
        FarmError::store(&self.full_name(name))(error)
    }

    fn key(&self, name: &str) -> Key {
        name.split('/').filter(|part| !part.is_empty()).fold(self.root.clone(), |key, part| key.join(part))
    }

    /// Runs a request, and again where another try may help.
    fn again<T, F: Future<Output = Result<T, StoreError>>>(&self, request: impl Fn() -> F) -> Result<T, StoreError> {
        let mut pause = FIRST_PAUSE;
        for _ in 1..ATTEMPTS {
            match self.runtime.block_on(request()) {
                Err(StoreError::Generic { .. } | StoreError::JoinError { .. }) => std::thread::sleep(pause),
                done => return done,
            }
            pause *= 2;
        }
        self.runtime.block_on(request())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder() -> (tempfile::TempDir, Store) {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::open(folder.path().to_str().unwrap(), std::iter::empty()).unwrap();
        (folder, store)
    }

    #[test]
    fn threads_that_cannot_be_had_are_told_with_what_to_do() {
        ask_for_threads(WORKERS + 1, STACK).unwrap();
        // No machine has room for such a stack.
        let refused = ask_for_threads(2, 1 << (usize::BITS - 4)).unwrap_err();
        let error = FarmError::io(START_THREADS, Path::new("/shared/job"), refused);
        assert!(error.to_string().starts_with("cannot start threads for /shared/job: "), "{error}");
        assert!(error.hint().is_some_and(|hint| hint.contains("ulimit -u")) && error.is_transient());
    }

    #[test]
    fn objects_come_back_and_are_listed_in_order() {
        let (_folder, store) = folder();
        store.put("b/two", vec![2; 20]).unwrap();
        store.put("b/one", b"1".to_vec()).unwrap();
        store.put("a", b"0".to_vec()).unwrap();
        store.put("b/one", b"11".to_vec()).unwrap();
        assert_eq!(store.get("b/one").unwrap().unwrap(), b"11");
        assert_eq!(store.get("b/three").unwrap(), None);
        assert_eq!([store.size("b/two").unwrap(), store.size("b/three").unwrap()], [Some(20), None]);
        assert_eq!(store.list("b").unwrap(), [("b/one".to_string(), 2), ("b/two".to_string(), 20)]);
        assert_eq!(store.list("none").unwrap(), []);
        store.remove("b/one").unwrap();
        store.remove("b/one").unwrap();
        assert_eq!(store.get("b/one").unwrap(), None);
    }

    #[test]
    fn of_several_writers_one_succeeds() {
        let (_folder, store) = folder();
        store.probe("test").unwrap();
        assert_eq!(store.list("probe").unwrap(), []);
        assert_eq!(store.create("x", b"first").unwrap(), Created::Yes);
        assert_eq!(store.create("x", b"second").unwrap(), Created::Taken);
        assert_eq!(store.get("x").unwrap().unwrap(), b"first");
    }

    #[test]
    fn variables_of_other_programs_are_no_settings_of_buckets() {
        let settings =
            [("TIMEOUT", "30"), ("TOKEN", "x"), ("AWS_REGION", "eu-west-1"), ("AWS_ACCESS_KEY_ID", "a"), ("AWS_SECRET_ACCESS_KEY", "b")];
        let settings = settings.into_iter().map(|(name, value)| (name.to_string(), value.to_string()));
        assert_eq!(Store::open("s3://bucket/job/", settings).unwrap().url(), "s3://bucket/job");
        let wrong = std::iter::once(("AWS_TIMEOUT".to_string(), "30".to_string()));
        assert!(Store::open("s3://bucket/job", wrong).unwrap_err().to_string().contains("30"), "a setting that is one counts");
    }

    #[test]
    fn folders_of_something_else_are_left_and_none_is_made_by_looking() {
        let dir = tempfile::tempdir().unwrap();
        let place = |name: &str| dir.path().join(name).to_str().unwrap().to_string();
        let begin = |name: &str| Store::begin(&place(name), std::iter::empty());
        let error = Store::open(&place("none"), std::iter::empty()).unwrap_err().to_string();
        assert!(error.contains("none does not exist; plan a job") && !dir.path().join("none").exists(), "{error}");
        begin("job/new").unwrap().put("objects/a", vec![1]).unwrap();
        begin("job/new").unwrap();
        std::fs::write(dir.path().join("job/new/room.obj"), "v 0 0 0").unwrap();
        let error = begin("job/new").unwrap_err().to_string();
        assert!(error.contains("room.obj") && error.contains("an empty folder"), "{error}");
        // Scripts of an engine may be in the folder of a job.
        Store::open(&place("job/new"), std::iter::empty()).unwrap().put(PLAN, vec![1]).unwrap();
        begin("job/new").unwrap();
    }

    #[test]
    #[cfg(unix)]
    fn a_link_that_leads_nowhere_is_no_place_for_a_job() {
        let dir = tempfile::tempdir().unwrap();
        let link = dir.path().join("job");
        std::os::unix::fs::symlink("gone", &link).unwrap();
        let error = Store::begin(link.to_str().unwrap(), std::iter::empty()).unwrap_err().to_string();
        assert!(error.contains("job is a broken link"), "{error}");
    }

    #[test]
    fn places_that_mean_nothing_are_told() {
        let error = Store::open("ftp://host/x", std::iter::empty()).unwrap_err().to_string();
        assert!(error.contains("ftp://host/x"), "{error}");
    }
}
