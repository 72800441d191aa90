//! The page in a notebook: its files, and its questions answered without a server.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use kickdrift::error::Result;
use kickdrift::explore::{self, Reply, Session};
use kickdrift::number::parse::{parse, parse_range};
use kickdrift::scene::SystemScene;
use numpy::PyReadonlyArrayDyn;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::error::raised;
use crate::program::held;

/// What stops a question on its way.
#[pyclass(frozen, module = "kickdrift._native")]
pub struct Stop(Arc<AtomicBool>);

#[pymethods]
impl Stop {
    #[new]
    fn new() -> Stop {
        Stop(Arc::default())
    }

    fn set(&self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// What a page starts on.
#[pyclass(frozen, module = "kickdrift._native")]
pub struct Page(Session);

#[pymethods]
impl Page {
    /// Seconds that a question may take.
    #[classattr]
    const LONGEST: f64 = explore::LONGEST.as_secs_f64();

    /// The plane of two stiffnesses, the window as texts where one is given.
    #[staticmethod]
    fn of_springs(
        lambda1: &str,
        lambda2: &str,
        window: Option<[String; 2]>,
        unit: Option<&str>,
    ) -> PyResult<Page> {
        let session = || -> Result<Session> {
            let session = Session::new(parse("lambda1", lambda1)?, parse("lambda2", lambda2)?)?;
            Ok(match &window {
                Some([h1, h2]) => session.within([parse_range("h1", h1)?, parse_range("h2", h2)?]),
                None => session,
            })
        };
        let session = session().map_err(|error| raised(&error))?;
        Ok(Page(match unit {
            Some(unit) => session.in_unit(unit),
            None => session,
        }))
    }

    /// A system, the text of its file; its arrays by name, or the folder that they are in.
    #[staticmethod]
    fn of_system(
        text: &str,
        arrays: BTreeMap<String, PyReadonlyArrayDyn<'_, f64>>,
        folder: Option<PathBuf>,
    ) -> PyResult<Page> {
        let arrays = match folder {
            Some(folder) => folder.as_path().into(),
            None => held(arrays)?,
        };
        let system = SystemScene::read_in(arrays, text).map_err(|error| raised(&error))?;
        Ok(Page(Session::of_system(system)))
    }

    /// The status, the type and the bytes of the answer to a question, or of a file of the page; other
    /// threads of Python run meanwhile.
    fn ask<'py>(&self, py: Python<'py>, path: &str, query: &str, stop: &Stop) -> Answer<'py> {
        let answer = || explore::ask(&self.0, path, query, &stop.0).or_else(|| explore::asset(path));
        match py.detach(answer) {
            Some(reply) => shared(py, &reply),
            None => (404, "text/plain; charset=utf-8", PyBytes::new(py, b"there is nothing here")),
        }
    }

    /// The same of what takes longer than `LONGEST`.
    #[staticmethod]
    fn overdue<'py>(py: Python<'py>, path: &str) -> Answer<'py> {
        shared(py, &explore::overdue(path))
    }
}

/// Status, type and bytes.
type Answer<'py> = (u16, &'static str, Bound<'py, PyBytes>);

fn shared<'py>(py: Python<'py>, reply: &Reply) -> Answer<'py> {
    (reply.status, reply.media, PyBytes::new(py, &reply.bytes))
}
