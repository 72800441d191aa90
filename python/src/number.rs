//! Exact numbers from what Python has, and back.

use std::cmp::Ordering;

use kickdrift::number::parse::{MAX_BITS, parse};
use kickdrift::number::{Laurent, Rational};
use num_bigint::BigInt;
use pyo3::basic::CompareOp;
use pyo3::exceptions::{PyException, PyMemoryError, PyRecursionError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyFloat, PyInt, PyString};

use crate::arguments::is_no_value;
use crate::error::{raised, refused};

/// An exact number: a sum of c π^k with rational c.
#[pyclass(frozen, module = "kickdrift")]
#[derive(Clone)]
pub struct Number(pub Laurent);

#[pymethods]
impl Number {
    #[new]
    fn new(value: &Bound<'_, PyAny>) -> PyResult<Number> {
        quantity("number", value).map(Number)
    }

    fn __str__(&self) -> String {
        self.0.to_string()
    }

    fn __repr__(&self) -> String {
        format!("Number('{}')", self.0)
    }

    fn __float__(&self) -> f64 {
        self.0.to_f64()
    }

    fn __bool__(&self) -> bool {
        !self.0.terms().is_empty()
    }

    fn __reduce__(slf: &Bound<'_, Self>) -> PyResult<(Py<PyAny>, (String,))> {
        Ok((slf.get_type().into_any().unbind(), (slf.get().0.to_string(),)))
    }

    fn __hash__(&self, py: Python<'_>) -> PyResult<isize> {
        match self.0.as_rational() {
            Some(rational) => rational.into_pyobject(py)?.hash(),
            None => PyString::new(py, &self.0.to_string()).hash(),
        }
    }

    /// Equality and order with whatever denotes an exact number; anything else is neither.
    fn __richcmp__(&self, other: &Bound<'_, PyAny>, op: CompareOp) -> PyResult<Py<PyAny>> {
        let py = other.py();
        if other.is_instance_of::<PyString>() {
            return Ok(py.NotImplemented());
        }
        let other = match quantity("number", other) {
            Err(error) if is_refusal(py, &error) => return Ok(py.NotImplemented()),
            other => other?,
        };
        let order: Ordering = self.0.cmp(&other);
        Ok(PyBool::new(py, op.matches(order)).to_owned().into_any().unbind())
    }

    #[getter]
    fn fraction<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let remedy = "is irrational: use float(...), str(...) or to_sympy()";
        let rational =
            self.0.as_rational().ok_or_else(|| refused(py, "number", self.0.to_string(), remedy))?;
        Ok(rational.into_pyobject(py)?.into_any())
    }

    #[getter]
    fn is_rational(&self) -> bool {
        self.0.as_rational().is_some()
    }

    fn to_sympy<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        py.import("sympy")?.call_method1("sympify", (self.0.to_string().replace('^', "**"),))
    }
}

/// The exact number that a value denotes; an error names the field.
#[pyfunction]
pub fn number(field: &str, value: &Bound<'_, PyAny>) -> PyResult<Number> {
    quantity(field, value).map(Number)
}

/// What a value of Python denotes, exactly; a float is the number that it prints, its shortest decimal.
pub fn quantity(field: &str, value: &Bound<'_, PyAny>) -> PyResult<Laurent> {
    let py = value.py();
    if let Ok(number) = value.cast::<Number>() {
        return Ok(number.get().0.clone());
    }
    if let Ok(text) = value.cast::<PyString>() {
        return read(field, &text.to_string_lossy());
    }
    if value.is_instance_of::<PyBool>() {
        return Err(unknown(field, value));
    }
    if let Ok(double) = value.cast::<PyFloat>() {
        // Of a double of Python's own: those of NumPy's print their type too. (Rust breaks ties the other
        // way.)
        return printed(field, value, &PyFloat::new(py, double.value()).str()?.to_string_lossy());
    }
    if is_rounded(value)? {
        return printed(field, value, &value.str()?.to_string_lossy());
    }
    if is_long_decimal(value)? {
        return Err(too_long(field, value)?);
    }
    if let Ok(integer) = value.cast::<PyInt>() {
        return bounded(field, value, Rational::from_integer(integer.extract()?));
    }
    if let Some((above, below)) = terms(field, value)? {
        return bounded(field, value, Rational::new(above, below));
    }
    if of_sympy(value) {
        let inexact = value.call_method1("has", (py.import("sympy")?.getattr("Float")?,))?;
        if inexact.is_truthy()? {
            return Err(refused(
                py,
                field,
                shown(value)?,
                "holds a rounded number: write it as sympy.Rational",
            ));
        }
        return read(field, &value.str()?.to_string_lossy());
    }
    Err(unknown(field, value))
}

/// The same where it has to be rational.
pub fn rational(field: &str, value: &Bound<'_, PyAny>) -> PyResult<Rational> {
    let exact = quantity(field, value)?;
    exact.as_rational().ok_or_else(|| refused(value.py(), field, exact.to_string(), "must be rational"))
}

/// The shortest decimal of a float, as it prints.
fn printed(field: &str, value: &Bound<'_, PyAny>, digits: &str) -> PyResult<Laurent> {
    if digits.contains(['n', 'N']) {
        return Err(refused(value.py(), field, shown(value)?, "must be finite"));
    }
    read(field, digits)
}

/// A float of NumPy's that is no double: float16, float32, longdouble.
fn is_rounded(value: &Bound<'_, PyAny>) -> PyResult<bool> {
    let Some(dtype) = value.getattr_opt("dtype")? else { return Ok(false) };
    let (kind, axes) = (dtype.getattr_opt("kind")?, value.getattr_opt("ndim")?);
    let is =
        |own: Option<Bound<'_, PyAny>>, other: &Bound<'_, PyAny>| own.map_or(Ok(false), |own| own.eq(other));
    let (float, scalar) = (PyString::new(value.py(), "f"), PyInt::new(value.py(), 0));
    Ok(is(kind, &float)? && is(axes, &scalar)?)
}

/// Whether a Decimal has more digits than a number may have, before or behind its point: `as_integer_ratio`
/// would write all of them.
fn is_long_decimal(value: &Bound<'_, PyAny>) -> PyResult<bool> {
    let py = value.py();
    if !value.is_instance(&py.import("decimal")?.getattr("Decimal")?)?
        || !value.call_method0("is_finite")?.is_truthy()?
    {
        return Ok(false);
    }
    let parts = value.call_method0("as_tuple")?;
    let (digits, exponent) =
        (parts.getattr("digits")?.len()? as i64, parts.getattr("exponent")?.extract::<i64>()?);
    // Three bits a digit, at least.
    let most = MAX_BITS as i64 / 3;
    Ok(value.is_truthy()? && (digits > most || exponent.saturating_abs() > most))
}

/// Text; powers as Python writes them, too.
fn read(field: &str, text: &str) -> PyResult<Laurent> {
    parse(field, &text.replace("**", "^")).map_err(|error| raised(&error))
}

/// Numerator and denominator of fractions, of NumPy's and SymPy's numbers, decimals and the like.
fn terms(field: &str, value: &Bound<'_, PyAny>) -> PyResult<Option<(BigInt, BigInt)>> {
    let py = value.py();
    // Either may be a method, or what no number is.
    let whole = |found: Option<Bound<'_, PyAny>>| match found.map(|own| own.extract::<BigInt>()).transpose() {
        Err(error) if is_no_value(py, &error) => Ok(None),
        found => found,
    };
    let both = (whole(value.getattr_opt("numerator")?)?, whole(value.getattr_opt("denominator")?)?);
    if let (Some(above), Some(below)) = both
        && below != BigInt::ZERO
    {
        return Ok(Some((above, below)));
    }
    let Some(method) = value.getattr_opt("as_integer_ratio")? else { return Ok(None) };
    let ratio = match method.call0() {
        // Infinities and NaN have none.
        Err(error) if is_no_value(py, &error) => {
            return Err(refused(py, field, shown(value)?, "must be finite"));
        }
        ratio => ratio?,
    };
    match ratio.extract::<(BigInt, BigInt)>() {
        Ok((above, below)) if below != BigInt::ZERO => Ok(Some((above, below))),
        Err(error) if !is_no_value(py, &error) => Err(error),
        _ => {
            let remedy = format!(
                "its as_integer_ratio() is {}: give two integers, the second one not 0",
                shown(&ratio)?
            );
            Err(refused(py, field, shown(value)?, &remedy))
        }
    }
}

fn bounded(field: &str, value: &Bound<'_, PyAny>, rational: Rational) -> PyResult<Laurent> {
    if rational.numer().bits().max(rational.denom().bits()) > MAX_BITS {
        return Err(too_long(field, value)?);
    }
    Ok(Laurent::from_rational(rational))
}

fn too_long(field: &str, value: &Bound<'_, PyAny>) -> PyResult<PyErr> {
    let remedy = format!("has more than {MAX_BITS} bits above or below: choose a simpler number");
    Ok(refused(value.py(), field, value.get_type().name()?.to_string(), &remedy))
}

fn of_sympy(value: &Bound<'_, PyAny>) -> bool {
    let module = value.get_type().module().map(|module| module.to_string());
    module.is_ok_and(|module| module == "sympy" || module.starts_with("sympy."))
}

fn unknown(field: &str, value: &Bound<'_, PyAny>) -> PyErr {
    let remedy = "give an int, a Fraction, a Decimal, a text such as 'pi^2/25', a SymPy number, or a float, which means \
                  what it prints";
    shown(value).map_or_else(|error| error, |shown| refused(value.py(), field, shown, remedy))
}

/// The representation of a value, or its type where it has none.
///
/// # Errors
/// Exceptions that are not about the value, as Ctrl-C.
pub fn shown(value: &Bound<'_, PyAny>) -> PyResult<String> {
    match value.repr() {
        Ok(text) => Ok(text.to_string_lossy().into_owned()),
        Err(error)
            if error.is_instance_of::<PyException>(value.py()) && !is_of_the_process(value.py(), &error) =>
        {
            Ok(format!("a {}", value.get_type().name()?))
        }
        Err(error) => Err(error),
    }
}

/// Whether an exception is about the process and no value.
fn is_of_the_process(py: Python<'_>, error: &PyErr) -> bool {
    error.is_instance_of::<PyMemoryError>(py) || error.is_instance_of::<PyRecursionError>(py)
}

/// Whether an exception is ours: a value that is refused.
pub fn is_refusal(py: Python<'_>, error: &PyErr) -> bool {
    let class = py.import("kickdrift._errors").and_then(|module| module.getattr("KickdriftError"));
    class.and_then(|class| error.value(py).is_instance(&class)).unwrap_or(false)
}
