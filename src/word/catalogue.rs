pub struct Method { pub name: &'static str, pub word: &'static str, pub source: &'static str }
pub const METHODS: &[Method] = &[];
pub fn method(_: &str) -> crate::error::Result<&'static Method> { unimplemented!() }
