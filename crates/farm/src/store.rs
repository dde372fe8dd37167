//! The store that decides what is done: a folder that all nodes see, or a bucket of S3, Google Cloud Storage or Azure.
//!
//! Little is asked of it: objects appear whole, and of several writers of one name with [`Store::create`] exactly one succeeds.
//! [`Store::probe`] finds out whether it keeps to that.

use crate::FarmError;
use futures_util::TryStreamExt;
use object_store::local::LocalFileSystem;
use object_store::path::Path as Key;
use object_store::{Error as StoreError, ObjectStore, ObjectStoreExt, PutMode, PutOptions, PutPayload};
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;
use tokio::runtime::Runtime;

/// How often something is tried that fails for no lasting reason.
const ATTEMPTS: u32 = 5;
/// Before the second attempt; doubled before each further one.
const FIRST_PAUSE: Duration = Duration::from_millis(100);
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

/// What became of an object that only one may write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Created {
    /// It is there now, as given.
    Yes,
    /// The name is taken: by somebody else, or by an earlier try whose answer was lost.
    Taken,
}

impl Store {
    /// The store at `place`: a folder, which is made if need be, or a URL: `file://`, `s3://bucket/prefix`, `gs://`, `az://`. Keys,
    /// regions and endpoints are taken from `settings`, usually the environment, under the names that these services use
    /// (`AWS_ACCESS_KEY_ID`, `AWS_ENDPOINT_URL`, `GOOGLE_APPLICATION_CREDENTIALS`, `AZURE_STORAGE_ACCOUNT_NAME`, …).
    ///
    /// # Errors
    /// When the place cannot be understood or made.
    pub fn open(place: &str, settings: impl Iterator<Item = (String, String)>) -> Result<Self, FarmError> {
        let runtime = tokio::runtime::Builder::new_multi_thread().worker_threads(2).enable_all().build();
        let runtime = runtime.map_err(|source| FarmError::io("start threads for", Path::new(place), source))?;
        let folder = match place.split_once("://") {
            None => Some(place),
            Some(("file", path)) => Some(path),
            Some(_) => None,
        };
        if let Some(folder) = folder {
            let io = |source| FarmError::io("make the folder", Path::new(folder), source);
            std::fs::create_dir_all(folder).map_err(io)?;
            let absolute = std::fs::canonicalize(folder).map_err(io)?;
            let inner = LocalFileSystem::new_with_prefix(&absolute).map_err(FarmError::store(place))?.with_fsync(true);
            return Ok(Self { inner: Arc::new(inner), root: Key::default(), url: absolute.display().to_string(), runtime });
        }
        // Another provider, if the program has set one, is as good.
        let _ = rustls::crypto::ring::default_provider().install_default();
        let url = url::Url::parse(place).map_err(|error| FarmError::Place { place: place.into(), problem: error.to_string() })?;
        let settings = settings.map(|(name, value)| (name.to_ascii_lowercase(), value));
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
        self.again(|| self.inner.put(&key, payload.clone())).map(drop).map_err(FarmError::store(name))
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
            Err(error) => Err(FarmError::store(name)(error)),
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
            Err(error) => Err(FarmError::store(name)(error)),
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
            Err(error) => Err(FarmError::store(name)(error)),
        }
    }

    /// The names of all objects below `folder`, with their sizes in bytes, in the order of names.
    ///
    /// # Errors
    /// When the store does not answer.
    pub fn list(&self, folder: &str) -> Result<Vec<(String, u64)>, FarmError> {
        let prefix = self.key(folder);
        let read = || async { self.inner.list(Some(&prefix)).try_collect::<Vec<_>>().await };
        let found = self.again(read).map_err(FarmError::store(folder))?;
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
            let name = format!("probe/{unique}-{round}");
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
                let later = if again == Created::Yes { "a later one was told so too" } else { "a later one was refused" };
                let problem = format!("of {PROBE_WRITERS} writers of one new object {won} were told that they made it, and {later}");
                return Err(FarmError::Unreliable { place: self.url.clone(), problem });
            }
        }
        Ok(())
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
    fn objects_come_back_and_are_listed_in_order() {
        let (_folder, store) = folder();
        store.put("b/two", vec![2; 20]).unwrap();
        store.put("b/one", b"1".to_vec()).unwrap();
        store.put("a", b"0".to_vec()).unwrap();
        store.put("b/one", b"11".to_vec()).unwrap();
        assert_eq!(store.get("b/one").unwrap().unwrap(), b"11");
        assert_eq!(store.get("b/three").unwrap(), None);
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
    fn places_that_mean_nothing_are_told() {
        let error = Store::open("ftp://host/x", std::iter::empty()).unwrap_err().to_string();
        assert!(error.contains("ftp://host/x"), "{error}");
    }
}
