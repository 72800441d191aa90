//! What the sources import, read from their tokens: `use` trees and paths in the code, in the module they
//! stand in. A crate in crates/ counts as a module, named as its folder is.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use proc_macro2::{TokenStream, TokenTree};

/// A path that a source names, from the library's root on.
#[derive(Clone, Debug, PartialEq)]
pub struct Import {
    pub path: Vec<String>,
    /// The name that a `use` binds; none for a path in the code and for a glob.
    binds: Option<String>,
    /// `pub use`, restricted or not.
    handed_on: bool,
    /// Under `#[cfg(test)]`.
    pub in_tests: bool,
}

/// One source.
#[derive(Debug, Default)]
pub struct Source {
    /// Its path below src/; below the repository in crates/.
    pub file: String,
    pub imports: Vec<Import>,
    /// All names in its code, `use` items and tests apart.
    names: BTreeSet<String>,
}

/// The sources of all crates.
pub struct Sources {
    pub all: Vec<Source>,
    of_module: BTreeMap<Vec<String>, usize>,
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let all = entries.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] });
    all.filter(|path| path.extension().is_some_and(|extension| extension == "rs")).collect()
}

impl Sources {
    /// Those in src/ and crates/ below `root`.
    pub fn read(root: &Path) -> Sources {
        let below = |folder: &Path, base: &Path| -> Vec<(String, String)> {
            let inside = |path: &PathBuf| path.strip_prefix(base).unwrap().to_str().unwrap().to_string();
            files(folder).iter().map(|path| (inside(path), fs::read_to_string(path).unwrap())).collect()
        };
        let mut texts = below(&root.join("src"), &root.join("src"));
        let crates =
            fs::read_dir(root.join("crates")).unwrap().map(|entry| entry.unwrap().path().join("src"));
        texts.extend(crates.flat_map(|folder| below(&folder, root)));
        texts.sort();
        Sources::of(&texts)
    }

    /// From the texts of files.
    pub fn of(texts: &[(String, String)]) -> Sources {
        let modules: Vec<Vec<String>> = texts.iter().map(|(file, _)| module(file)).collect();
        let of_module: BTreeMap<_, _> = modules.iter().cloned().zip(0..).collect();
        let apart = |(text, module): (&(String, String), &Vec<String>)| {
            text.0.starts_with(CRATES).then(|| module[0].clone())
        };
        let crates: BTreeSet<String> = texts.iter().zip(&modules).filter_map(apart).collect();
        let read = |((file, text), module): (&(String, String), &Vec<String>)| {
            let mut source = Source { file: file.clone(), ..Source::default() };
            let of_library = !file.starts_with(CRATES);
            let root = if of_library { &[][..] } else { &module[..1] };
            let module = module.clone();
            let scope = Scope { root, module, in_tests: false, modules: &of_module, crates: &crates };
            scope.read(text.parse().expect("Rust"), &mut source);
            source
        };
        Sources { all: texts.iter().zip(&modules).map(read).collect(), of_module }
    }

    /// The source that defines what the path names: re-exports are followed to their end.
    fn definition(&self, path: &[String]) -> usize {
        let depth = (0..=path.len()).rev().find(|&n| self.of_module.contains_key(&path[..n]));
        let depth = depth.expect("the root is a module");
        let at = self.of_module[&path[..depth]];
        let Some(name) = path.get(depth) else { return at };
        let bound = self.all[at].imports.iter().find(|import| import.binds.as_ref() == Some(name));
        let Some(bound) = bound.filter(|bound| bound.path != path[..=depth]) else { return at };
        self.definition(&[&bound.path[..], &path[depth + 1..]].concat())
    }

    /// For each source the sources that its code, tests apart, takes something from. Handing on a name that
    /// the source does not use itself is no such tie.
    pub fn ties(&self) -> Vec<BTreeSet<usize>> {
        let ties = |(at, source): (usize, &Source)| {
            let taken = |import: &&Import| {
                !import.in_tests
                    && (!import.handed_on
                        || import.binds.as_ref().is_some_and(|name| source.names.contains(name)))
            };
            let to = source.imports.iter().filter(taken).map(|import| self.definition(&import.path));
            to.filter(|&to| to != at).collect()
        };
        self.all.iter().enumerate().map(ties).collect()
    }

    /// The circles: sets of sources each of which needs all others, directly or through others.
    pub fn circles(&self) -> Vec<BTreeSet<&str>> {
        let ties = self.ties();
        let reach = |from: usize| {
            let (mut seen, mut next) = (BTreeSet::new(), vec![from]);
            while let Some(at) = next.pop() {
                next.extend(ties[at].iter().filter(|&&to| seen.insert(to)));
            }
            seen
        };
        let reach: Vec<_> = (0..ties.len()).map(reach).collect();
        let circle = |at: usize| reach[at].iter().filter(|&&to| reach[to].contains(&at)).copied().collect();
        let circles: BTreeSet<BTreeSet<usize>> =
            (0..ties.len()).filter(|&at| reach[at].contains(&at)).map(circle).collect();
        circles.iter().map(|circle| circle.iter().map(|&at| self.all[at].file.as_str()).collect()).collect()
    }
}

const CRATES: &str = "crates/";

/// The module of a file: lib.rs and main.rs are the root of their crate.
fn module(file: &str) -> Vec<String> {
    let file = file.strip_suffix(".rs").expect("a Rust source");
    let file = file.strip_prefix(CRATES).map_or(file.into(), |file| file.replacen("/src/", "/", 1));
    let names = file.split('/').map(str::to_string);
    names.filter(|name| !["mod", "lib", "main"].contains(&name.as_str())).collect()
}

/// The module in which tokens stand.
struct Scope<'a> {
    /// The root of its crate.
    root: &'a [String],
    module: Vec<String>,
    in_tests: bool,
    modules: &'a BTreeMap<Vec<String>, usize>,
    /// The names of all crates but the library.
    crates: &'a BTreeSet<String>,
}

fn is(token: Option<&TokenTree>, text: &str) -> bool {
    token.is_some_and(|token| !matches!(token, TokenTree::Group(_)) && token.to_string() == text)
}

fn name(token: Option<&TokenTree>) -> Option<String> {
    if let Some(TokenTree::Ident(name)) = token { Some(name.to_string()) } else { None }
}

impl Scope<'_> {
    fn read(&self, stream: TokenStream, source: &mut Source) {
        let tokens: Vec<TokenTree> = stream.into_iter().collect();
        let mut at = 0;
        while at < tokens.len() {
            at += match &tokens[at] {
                TokenTree::Ident(word) if word == "mod" => self.read_module(&tokens, at, source),
                TokenTree::Ident(word) if word == "use" => self.read_use(&tokens, at, source),
                TokenTree::Ident(_) => self.read_path(&tokens[at..], source),
                TokenTree::Group(group) => {
                    self.read(group.stream(), source);
                    1
                }
                _ => 1,
            };
        }
    }

    /// `mod name { ... }`; returns how many tokens were read.
    fn read_module(&self, tokens: &[TokenTree], at: usize, source: &mut Source) -> usize {
        let (Some(inner), Some(TokenTree::Group(body))) = (name(tokens.get(at + 1)), tokens.get(at + 2))
        else {
            return 1;
        };
        let attribute = at.checked_sub(1).map_or(String::new(), |before| tokens[before].to_string());
        let in_tests = self.in_tests || attribute.replace(' ', "") == "[cfg(test)]";
        let module = [&self.module[..], &[inner]].concat();
        Scope { module, in_tests, ..*self }.read(body.stream(), source);
        3
    }

    fn read_use(&self, tokens: &[TokenTree], at: usize, source: &mut Source) -> usize {
        let length = tokens[at..].iter().position(|token| is(Some(token), ";")).unwrap_or(1);
        let before = |by: usize| at.checked_sub(by).and_then(|at| tokens.get(at));
        // `pub use`, `pub(crate) use`.
        let handed_on = is(before(1), "pub") || is(before(2), "pub");
        self.read_tree(&tokens[at + 1..at + length], &[], handed_on, source);
        length
    }

    /// One tree of a `use`, or several between commas.
    fn read_tree(&self, tokens: &[TokenTree], prefix: &[String], handed_on: bool, source: &mut Source) {
        for tree in tokens.split(|token| is(Some(token), ",")).filter(|tree| !tree.is_empty()) {
            let mut path = prefix.to_vec();
            let renamed = tree.iter().position(|token| is(Some(token), "as"));
            let (tree, alias) = tree.split_at(renamed.unwrap_or(tree.len()));
            path.extend(tree.iter().filter_map(|token| name(Some(token))));
            if let Some(TokenTree::Group(group)) = tree.last() {
                let inner: Vec<TokenTree> = group.stream().into_iter().collect();
                self.read_tree(&inner, &path, handed_on, source);
                continue;
            }
            let whole = path.len() > 1 && path.last().is_some_and(|last| last == "self");
            path.truncate(path.len() - usize::from(whole));
            let glob = is(tree.last(), "*");
            let binds = if glob { None } else { name(alias.get(1)).or_else(|| path.last().cloned()) };
            self.add(&path, binds, handed_on, source);
        }
    }

    /// A path in the code.
    fn read_path(&self, tokens: &[TokenTree], source: &mut Source) -> usize {
        let colons = |at: usize| is(tokens.get(at), ":") && is(tokens.get(at + 1), ":");
        let mut path = vec![name(tokens.first()).expect("a word")];
        let mut at = 1;
        while let Some(next) = name(tokens.get(at + 2)).filter(|_| colons(at)) {
            path.push(next);
            at += 3;
        }
        if !self.in_tests {
            source.names.extend(path.iter().cloned());
        }
        if path.len() > 1 {
            self.add(&path, None, false, source);
        }
        at
    }

    /// Notes the path, if it leads to a module of ours.
    fn add(&self, path: &[String], binds: Option<String>, handed_on: bool, source: &mut Source) {
        let child = [&self.module[..], &path[..1]].concat();
        let mut absolute = match path[0].as_str() {
            "crate" => self.root.to_vec(),
            "self" => self.module.clone(),
            "super" => self.module[..self.module.len() - 1].to_vec(),
            _ if self.modules.contains_key(&child) => child,
            _ if self.crates.contains(&path[0]) => path[..1].to_vec(),
            _ => return,
        };
        for step in &path[1..] {
            if step == "super" { drop(absolute.pop()) } else { absolute.push(step.clone()) }
        }
        source.imports.push(Import { path: absolute, binds, handed_on, in_tests: self.in_tests });
    }
}
