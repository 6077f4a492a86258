//! Imports inside each package: floors use only floors above them, and no files import each other
//! in a cycle. Between the packages Cargo checks that.
//!
//! The floors are the rows of the table in the docs of each `lib.rs`, so there is one list of them.
//! An import counts for the file that defines the item, so a `mod.rs` that only declares modules
//! and re-exports their items ties no files together. Test modules are not read.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// Text of the source files by their path from the crate's folder, such as `src/ui/slider.rs`.
type Sources = BTreeMap<String, String>;

/// Folders with the sources of the packages.
const PACKAGES: [&str; 2] = ["kinematics/src", "src"];

#[test]
fn each_floor_imports_only_floors_above_it() {
    for folder in PACKAGES {
        let sources = sources_in(folder);
        let floors = floors(&sources[&format!("{folder}/lib.rs")]);
        let faults = upward_imports(&Crate::read(&sources, folder), &floors);
        assert!(faults.is_empty(), "against the floors in {folder}/lib.rs:\n{}", faults.join("\n"));
    }
}

#[test]
fn no_files_import_each_other_in_a_cycle() {
    for folder in PACKAGES {
        let faults = cycles(&Crate::read(&sources_in(folder), folder));
        assert!(faults.is_empty(), "files that import each other:\n\n{}", faults.join("\n"));
    }
}

#[test]
fn only_a_track_poses_a_document_at_a_time() {
    for (file, text) in sources_in("src") {
        let ways = [".skeleton_at(", "rig.evaluate(", "apply_keys("];
        let found = ways.into_iter().find(|way| text.contains(way));
        let is_track = file.starts_with("src/document/track");
        assert!(found.is_none() || is_track, "{file}: {found:?}");
    }
}

#[test]
fn the_scene_solves_nothing() {
    for (file, text) in sources_in("src/scene") {
        let solves = [".solve(", "arm.pose()", "pose_with_reference(", "fk_at(", "Track"];
        let found = solves.into_iter().find(|solve| text.contains(solve));
        assert!(found.is_none(), "{file}: {found:?}");
    }
}

#[test]
fn the_table_of_floors_lists_every_module_of_its_package() {
    for folder in PACKAGES {
        let sources = sources_in(folder);
        let mut listed = floors(&sources[&format!("{folder}/lib.rs")]).concat();
        let mut declared: Vec<_> =
            Crate::read(&sources, folder).modules[0].children.keys().cloned().collect();
        // The program re-exports the library where its own modules expect it.
        listed.retain(|name| folder != "src" || name != "kinematics");
        listed.sort();
        declared.sort();
        assert_eq!(listed, declared);
    }
}

fn sources_in(folder: &str) -> Sources {
    fn collect(folder: &Path, sources: &mut Sources) {
        for entry in fs::read_dir(folder).expect("readable folder") {
            let path = entry.expect("readable entry").path();
            if path.is_dir() {
                collect(&path, sources);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let text = fs::read_to_string(&path).expect("readable source");
                sources.insert(path.to_string_lossy().replace('\\', "/"), text);
            }
        }
    }
    let mut sources = Sources::new();
    collect(Path::new(folder), &mut sources);
    sources
}

// The rules

/// The rows of the table in the docs of a package, top first: the modules of each.
fn floors(lib: &str) -> Vec<Vec<String>> {
    lib.lines()
        .filter_map(|line| line.strip_prefix("//! | "))
        .filter_map(|row| row.split('|').next())
        .filter(|cell| cell.contains('`'))
        .map(|cell| {
            cell.split(',').map(|name| name.trim().trim_matches(['[', ']', '`']).to_owned())
        })
        .map(Iterator::collect)
        .collect()
}

/// Name of the top-level module that a file belongs to.
fn top_module(file: &str) -> &str {
    let inside = file.split_once("src/").map_or(file, |(_, inside)| inside);
    inside.split('/').next().unwrap_or(inside).trim_end_matches(".rs")
}

/// Imports of something on a floor below the importing file's own.
fn upward_imports(read: &Crate, floors: &[Vec<String>]) -> Vec<String> {
    let height = |file: &str| {
        floors.iter().position(|floor| floor.iter().any(|name| name == top_module(file)))
    };
    let against = |import: &Import| match (height(&import.from), height(&import.to)) {
        (Some(from), Some(to)) => to > from,
        (Some(_), None) => true,
        (None, _) => false,
    };
    lines(read.imports().iter().filter(|import| against(import)))
}

/// Files that import each other, one text for each group: the shortest cycle, its imports, and the
/// other imports that tie the group together.
fn cycles(read: &Crate) -> Vec<String> {
    let imports: Vec<_> = read.imports().into_iter().filter(|import| import.ties).collect();
    let mut graph = Graph::new();
    for import in &imports {
        graph.entry(&import.from).or_default().insert(&import.to);
    }
    let reached: BTreeMap<&str, BTreeSet<&str>> =
        graph.keys().map(|&file| (file, reachable(&graph, file))).collect();
    let reaches = |a: &str, b: &str| reached.get(a).is_some_and(|files| files.contains(b));
    let mut seen: BTreeSet<&str> = BTreeSet::new();
    let mut texts = Vec::new();
    for &file in graph.keys() {
        if !reaches(file, file) || seen.contains(file) {
            continue;
        }
        let tied = |other: &&str| reaches(file, other) && reaches(other, file);
        let group: BTreeSet<&str> = graph.keys().copied().filter(tied).collect();
        seen.extend(&group);
        let cycles = group.iter().map(|start| shortest_cycle(&graph, start));
        let cycle = cycles.min_by_key(Vec::len).unwrap_or_default();
        let steps: BTreeSet<_> = cycle.windows(2).map(|pair| (pair[0], pair[1])).collect();
        let inside =
            |import: &&Import| group.contains(&*import.from) && group.contains(&*import.to);
        let (of_cycle, others): (Vec<_>, Vec<_>) = imports
            .iter()
            .filter(inside)
            .partition(|import| steps.contains(&(&*import.from, &*import.to)));
        let mut text = format!("{}\n  {}\n", cycle.join(" → "), lines(of_cycle).join("\n  "));
        if !others.is_empty() {
            let others = lines(others).join("\n    ");
            let _ =
                writeln!(text, "  {} files are tied in all, also by\n    {others}", group.len());
        }
        texts.push(text);
    }
    texts
}

/// Files with the files that they import.
type Graph<'a> = BTreeMap<&'a str, BTreeSet<&'a str>>;

fn reachable<'a>(graph: &Graph<'a>, start: &str) -> BTreeSet<&'a str> {
    let mut found = BTreeSet::new();
    let mut open = vec![start];
    while let Some(file) = open.pop() {
        for &next in graph.get(file).into_iter().flatten() {
            if found.insert(next) {
                open.push(next);
            }
        }
    }
    found
}

/// Files from `start` back to it, over as few others as possible.
fn shortest_cycle<'a>(graph: &Graph<'a>, start: &'a str) -> Vec<&'a str> {
    let mut routes = VecDeque::from([vec![start]]);
    let mut seen = BTreeSet::new();
    while let Some(route) = routes.pop_front() {
        for &next in graph.get(route[route.len() - 1]).into_iter().flatten() {
            let longer = [route.as_slice(), &[next]].concat();
            if next == start {
                return longer;
            }
            if seen.insert(next) {
                routes.push_back(longer);
            }
        }
    }
    Vec::new()
}

/// One file's use of an item that another file defines.
struct Import {
    from: String,
    line: usize,
    path: String,
    to: String,
    /// False for a re-export of something that the file itself does not use, and for a module's
    /// name: only what is then named inside that module counts.
    ties: bool,
}

/// One line for each pair of files, with the importing lines and what they import.
fn lines<'a>(imports: impl IntoIterator<Item = &'a Import>) -> Vec<String> {
    let mut pairs: BTreeMap<_, (BTreeSet<usize>, Vec<&str>)> = BTreeMap::new();
    for import in imports {
        let (lines, paths) = pairs.entry((&import.from, &import.to)).or_default();
        lines.insert(import.line);
        if !paths.contains(&import.path.as_str()) {
            paths.push(&import.path);
        }
    }
    let joined = |lines: BTreeSet<usize>| {
        lines.iter().map(ToString::to_string).collect::<Vec<_>>().join(",")
    };
    pairs
        .into_iter()
        .map(|((from, to), (lines, paths))| {
            format!("{from}:{} imports {} of {to}", joined(lines), paths.join(", "))
        })
        .collect()
}

// Names and what they mean

/// The modules of a crate; the first is its root.
struct Crate {
    modules: Vec<Module>,
}

#[derive(Default)]
struct Module {
    file: String,
    parent: usize,
    children: BTreeMap<String, usize>,
    items: BTreeSet<String>,
    uses: Vec<Use>,
    /// Paths in code, with their lines.
    paths: Vec<(Vec<String>, usize)>,
    /// Names in code outside `use` declarations that may mean an item.
    words: BTreeSet<String>,
}

/// One leaf of a `use` declaration.
struct Use {
    path: Vec<String>,
    /// Name that it has here; `*` for all names of a module.
    name: String,
    exported: bool,
    line: usize,
}

#[derive(Clone, Copy, PartialEq)]
enum Meaning {
    /// An item, by the module that defines it.
    ItemOf(usize),
    Module(usize),
}

impl Crate {
    /// Reads the package whose `lib.rs` lies in `folder`.
    fn read(sources: &Sources, folder: &str) -> Self {
        let root = Module { file: format!("{folder}/lib.rs"), ..Module::default() };
        let mut read = Self { modules: vec![root] };
        read.read_file(sources, 0, folder);
        read
    }

    /// Reads a module's file; the files of its children lie in `folder`.
    fn read_file(&mut self, sources: &Sources, module: usize, folder: &str) {
        let tokens = tokens(&sources[&self.modules[module].file]);
        self.read_items(sources, module, folder, &tokens);
    }

    fn read_items(&mut self, sources: &Sources, module: usize, folder: &str, tokens: &[Token]) {
        let text = |at: usize| tokens.get(at).map_or("", |token| token.text.as_str());
        let is_name =
            |at: usize| text(at).starts_with(|first: char| first.is_alphabetic() || first == '_');
        let mut depth = 0_usize;
        let mut exported = false;
        let mut at = 0;
        while at < tokens.len() {
            let line = tokens[at].line;
            let next = at + 1;
            match text(at) {
                "#" if text(next) == "[" || text(next) == "!" => {
                    let open = if text(next) == "!" { next + 1 } else { next };
                    let end = after_group(tokens, open);
                    let inside: String =
                        tokens[open + 1..end - 1].iter().map(|token| &*token.text).collect();
                    let tests = inside == "test"
                        || inside == "cfg(test)"
                        || inside.starts_with("cfg(all(test,");
                    at = if tests { after_item(tokens, end) } else { end };
                    continue;
                }
                "pub" => {
                    exported = true;
                    at = if text(next) == "(" { after_group(tokens, next) } else { next };
                    continue;
                }
                "mod" if is_name(next) && matches!(text(at + 2), ";" | "{") => {
                    let name = text(next).to_owned();
                    let inner = format!("{folder}/{name}");
                    let inline = text(at + 2) == "{";
                    let candidates = [format!("{inner}.rs"), format!("{inner}/mod.rs")];
                    let file = if inline {
                        Some(self.modules[module].file.clone())
                    } else {
                        candidates.into_iter().find(|file| sources.contains_key(file))
                    };
                    let end = if inline { after_group(tokens, at + 2) } else { at + 3 };
                    if let Some(file) = file {
                        let child = self.modules.len();
                        self.modules.push(Module { file, parent: module, ..Module::default() });
                        self.modules[module].children.insert(name, child);
                        if inline {
                            self.read_items(sources, child, &inner, &tokens[at + 3..end - 1]);
                        } else {
                            self.read_file(sources, child, &inner);
                        }
                    }
                    exported = false;
                    at = end;
                    continue;
                }
                "use" if is_name(next) || matches!(text(next), "{" | "::") => {
                    let mut uses = Vec::new();
                    at = use_tree(tokens, next, &[], exported, &mut uses);
                    self.modules[module].uses.append(&mut uses);
                    exported = false;
                    continue;
                }
                "macro_rules" if text(next) == "!" => {
                    self.modules[module].items.insert(text(at + 2).to_owned());
                }
                "struct" | "enum" | "union" | "trait" | "type" | "fn" | "const" | "static"
                    if depth == 0 && is_name(next) && text(next) != "fn" =>
                {
                    let name = if text(next) == "mut" { next + 1 } else { next };
                    self.modules[module].items.insert(text(name).to_owned());
                    exported = false;
                    // The name is no use of something else that bears it.
                    at = name + 1;
                    continue;
                }
                "{" => depth += 1,
                "}" => depth = depth.saturating_sub(1),
                _ if is_name(at) => {
                    let mut path = vec![text(at).to_owned()];
                    let member = at > 0 && text(at - 1) == "." && text(at.wrapping_sub(2)) != ".";
                    if !member && text(next) != ":" {
                        self.modules[module].words.insert(text(at).to_owned());
                    }
                    while text(at + 1) == "::" && is_name(at + 2) {
                        path.push(text(at + 2).to_owned());
                        at += 2;
                    }
                    if path.len() > 1 && !member {
                        self.modules[module].paths.push((path, line));
                    }
                }
                _ => {}
            }
            if !matches!(text(at), "unsafe" | "async" | "extern") {
                exported = false;
            }
            at += 1;
        }
    }

    fn imports(&self) -> Vec<Import> {
        let mut imports = Vec::new();
        for (index, module) in self.modules.iter().enumerate().skip(1) {
            let mut add = |line: usize, path: &[String], meaning: Option<Meaning>, ties: bool| {
                let (to, ties) = match meaning {
                    Some(Meaning::ItemOf(to)) => (to, ties),
                    Some(Meaning::Module(to)) => (to, false),
                    None => return,
                };
                let (from, to) = (module.file.clone(), self.modules[to].file.clone());
                if from != to {
                    imports.push(Import { from, line, path: path.join("::"), to, ties });
                }
            };
            for used in &module.uses {
                if used.name != "*" {
                    let ties = !used.exported || module.words.contains(&used.name);
                    add(used.line, &used.path, self.resolve(index, &used.path, 0), ties);
                    continue;
                }
                let Some(Meaning::Module(all)) = self.resolve(index, &used.path, 0) else {
                    continue;
                };
                for word in &module.words {
                    let path = [used.path.as_slice(), std::slice::from_ref(word)].concat();
                    add(used.line, &path, self.look_up(all, word, true, 0), true);
                }
            }
            for (path, line) in &module.paths {
                add(*line, path, self.resolve(index, path, 0), true);
            }
        }
        imports
    }

    /// Meaning of a path in a module; `None` outside the crate. A name that is not found, such as
    /// one that a macro defines, belongs to the module before it.
    fn resolve(&self, module: usize, path: &[String], depth: usize) -> Option<Meaning> {
        let (first, rest) = path.split_first()?;
        let mut found = match first.as_str() {
            "crate" => Meaning::Module(0),
            "self" => Meaning::Module(module),
            "super" => Meaning::Module(self.modules[module].parent),
            name => self.look_up(module, name, rest.is_empty(), depth)?,
        };
        for (place, name) in rest.iter().enumerate() {
            let Meaning::Module(inside) = found else { break };
            found = match name.as_str() {
                "self" => found,
                "super" => Meaning::Module(self.modules[inside].parent),
                name => match self.look_up(inside, name, place + 1 == rest.len(), depth) {
                    Some(meaning) => meaning,
                    None if self.modules[inside].uses.iter().any(|used| used.name == name) => {
                        // A re-export from another crate.
                        return None;
                    }
                    None => Meaning::ItemOf(inside),
                },
            };
        }
        Some(found)
    }

    /// Meaning of a name in a module. One name may be a module and an item: at the end of a path it
    /// is the item, before that the module.
    fn look_up(&self, module: usize, name: &str, last: bool, depth: usize) -> Option<Meaning> {
        // Two modules may import all of each other.
        if depth > 16 {
            return None;
        }
        let here = &self.modules[module];
        let child = here.children.get(name).map(|&child| Meaning::Module(child));
        let item = here.items.contains(name).then_some(Meaning::ItemOf(module));
        let imported = || {
            let named = here.uses.iter().filter(|used| used.name == name);
            let meanings: Vec<_> =
                named.filter_map(|used| self.resolve(module, &used.path, depth + 1)).collect();
            let wanted = |meaning: &&Meaning| matches!(meaning, Meaning::ItemOf(_)) == last;
            meanings.iter().find(wanted).or(meanings.first()).copied()
        };
        let globbed = || {
            here.uses.iter().filter(|used| used.name == "*").find_map(|used| {
                match self.resolve(module, &used.path, depth + 1)? {
                    Meaning::Module(all) if all != module => {
                        self.look_up(all, name, last, depth + 1)
                    }
                    _ => None,
                }
            })
        };
        if !last && child.is_some() {
            return child;
        }
        match item.or_else(imported) {
            Some(Meaning::Module(_)) | None if child.is_some() => child,
            found => found.or_else(globbed),
        }
    }
}

// Reading Rust

#[derive(Debug, PartialEq)]
struct Token {
    text: String,
    line: usize,
}

/// Names, `::` and single characters of a source text; comments, literals in quotes and lifetimes
/// are left out.
fn tokens(source: &str) -> Vec<Token> {
    let chars: Vec<char> = source.chars().collect();
    let char_at = |at: usize| chars.get(at).copied().unwrap_or('\0');
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let mut tokens = Vec::new();
    let (mut at, mut line) = (0, 1);
    while at < chars.len() {
        let start = at;
        let mut text = String::new();
        match (chars[at], char_at(at + 1)) {
            ('/', '/') => {
                while at < chars.len() && chars[at] != '\n' {
                    at += 1;
                }
            }
            ('/', '*') => {
                let mut depth = 0;
                loop {
                    match (char_at(at), char_at(at + 1)) {
                        ('/', '*') => (depth, at) = (depth + 1, at + 2),
                        ('*', '/') => (depth, at) = (depth - 1, at + 2),
                        _ => at += 1,
                    }
                    if depth == 0 || at >= chars.len() {
                        break;
                    }
                }
            }
            ('"', _) => at = after_string(&chars, at),
            ('\'', '\\') => {
                at += 3;
                while at < chars.len() && chars[at] != '\'' {
                    at += 1;
                }
                at += 1;
            }
            ('\'', _) if char_at(at + 2) == '\'' => at += 3,
            ('\'', _) => {
                at += 1;
                while is_word(char_at(at)) {
                    at += 1;
                }
            }
            (':', ':') => {
                text.push_str("::");
                at += 2;
            }
            (first, _) if is_word(first) => {
                while is_word(char_at(at)) {
                    at += 1;
                }
                text.extend(&chars[start..at]);
                if matches!(text.as_str(), "r" | "br" | "cr" | "b" | "c") {
                    let hashes = chars[at..].iter().take_while(|c| **c == '#').count();
                    if char_at(at + hashes) == '"' {
                        at = if text.contains('r') {
                            after_raw_string(&chars, at + hashes + 1, hashes)
                        } else {
                            after_string(&chars, at)
                        };
                        text.clear();
                    } else if hashes == 1 && text == "r" {
                        // A raw identifier.
                        at += 1;
                        text.clear();
                    }
                }
            }
            (other, _) => {
                at += 1;
                if !other.is_whitespace() {
                    text.push(other);
                }
            }
        }
        if !text.is_empty() {
            tokens.push(Token { text, line });
        }
        at = at.min(chars.len());
        line += chars[start..at].iter().filter(|c| **c == '\n').count();
    }
    tokens
}

/// Index after a string whose opening quote is at `open`.
fn after_string(chars: &[char], open: usize) -> usize {
    let mut at = open + 1;
    while at < chars.len() && chars[at] != '"' {
        at += if chars[at] == '\\' { 2 } else { 1 };
    }
    at + 1
}

fn after_raw_string(chars: &[char], mut at: usize, hashes: usize) -> usize {
    let closed = |at: usize| chars.iter().skip(at + 1).take(hashes).filter(|c| **c == '#').count();
    while at < chars.len() && !(chars[at] == '"' && closed(at) == hashes) {
        at += 1;
    }
    at + 1 + hashes
}

/// Index after the bracket that closes the one at `open`.
fn after_group(tokens: &[Token], open: usize) -> usize {
    let mut depth = 0;
    for (at, token) in tokens.iter().enumerate().skip(open) {
        match token.text.as_str() {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return at + 1;
        }
    }
    tokens.len()
}

/// Index after the item, statement or field that begins at `at`.
fn after_item(tokens: &[Token], mut at: usize) -> usize {
    let text = |at: usize| tokens.get(at).map_or("", |token| token.text.as_str());
    while text(at) == "#" {
        at = after_group(tokens, at + 1);
    }
    let field = text(at + 1) == ":";
    let import = text(at) == "use" || text(at) == "pub";
    while at < tokens.len() {
        match text(at) {
            ";" => return at + 1,
            "," if field => return at + 1,
            "}" | ")" | "]" => return at,
            "{" if !import || text(at.wrapping_sub(1)) != "::" => return after_group(tokens, at),
            "(" | "[" | "{" => at = after_group(tokens, at),
            _ => at += 1,
        }
    }
    at
}

/// Reads one tree of a `use` declaration after `prefix`; the index after its `;`, `,` or `}`.
fn use_tree(
    tokens: &[Token],
    mut at: usize,
    prefix: &[String],
    exported: bool,
    uses: &mut Vec<Use>,
) -> usize {
    let text = |at: usize| tokens.get(at).map_or("", |token| token.text.as_str());
    let mut path = prefix.to_vec();
    let mut alias = None;
    let line = tokens.get(at).map_or(0, |token| token.line);
    loop {
        match text(at) {
            "::" => at += 1,
            "{" => {
                at += 1;
                while !matches!(text(at), "}" | "") {
                    at = use_tree(tokens, at, &path, exported, uses);
                }
                at += 1;
                if matches!(text(at), ";" | ",") {
                    at += 1;
                }
                return at;
            }
            "as" => {
                alias = Some(text(at + 1).to_owned());
                at += 2;
            }
            "," | ";" | "}" | "" => {
                if path.len() > 1 && path.last().is_some_and(|name| name == "self") {
                    path.pop();
                }
                let last = path.last().cloned().unwrap_or_default();
                let name = alias.unwrap_or_else(|| last.clone());
                if last == "*" {
                    path.pop();
                }
                uses.push(Use { path, name, exported, line });
                return if text(at) == "}" { at } else { at + 1 };
            }
            name => {
                path.push(name.to_owned());
                at += 1;
            }
        }
    }
}

// Made-up crates in which something is wrong, or only looks so

fn made_up(files: &[(&str, &str)]) -> Crate {
    let lib = ("src/lib.rs", "mod low; mod high;");
    let empty = [("src/low/mod.rs", ""), ("src/high/mod.rs", "")];
    let all = [lib].into_iter().chain(empty).chain(files.iter().copied());
    Crate::read(&all.map(|(file, text)| (file.to_owned(), text.to_owned())).collect(), "src")
}

/// The first cycle that is found, as the names of its files.
fn cycle(files: &[(&str, &str)]) -> Option<String> {
    cycles(&made_up(files)).first().and_then(|text| text.lines().next()).map(str::to_owned)
}

#[test]
fn two_files_that_import_each_other_are_found_with_their_lines() {
    let found = cycles(&made_up(&[
        ("src/low/mod.rs", "mod a; mod b;"),
        ("src/low/a.rs", "//! A.\nuse super::b::B;\npub struct A(B);"),
        ("src/low/b.rs", "pub struct B;\nimpl B { fn a() -> super::a::A { todo!() } }"),
    ]));
    assert_eq!(found.len(), 1);
    assert_eq!(
        found[0],
        "src/low/a.rs → src/low/b.rs → src/low/a.rs\n  \
         src/low/a.rs:2 imports super::b::B of src/low/b.rs\n  \
         src/low/b.rs:2 imports super::a::A of src/low/a.rs\n"
    );
}

#[test]
fn a_cycle_of_three_files_is_found_through_nested_groups() {
    let files = [
        ("src/low/mod.rs", "mod a; mod b; mod c;"),
        ("src/low/a.rs", "use crate::{low::{b::{self, B}, c as _}, high};\npub struct A(B);"),
        ("src/low/b.rs", "use super::c; pub struct B(c::C);"),
        ("src/low/c.rs", "pub struct C; fn a(_: Vec<crate::low::a::A>) {}"),
    ];
    let expected = "src/low/a.rs → src/low/b.rs → src/low/c.rs → src/low/a.rs";
    assert_eq!(cycle(&files).as_deref(), Some(expected));
}

#[test]
fn a_cycle_through_a_re_export_names_the_files_behind_it() {
    let files = [
        ("src/low/mod.rs", "mod a; mod deep; pub use a::A; pub use deep::Deep as Renamed;"),
        ("src/low/a.rs", "use super::Renamed; pub struct A(Renamed);"),
        ("src/low/deep/mod.rs", "mod inner; pub use inner::*;"),
        ("src/low/deep/inner.rs", "use super::super::A; pub struct Deep(A);"),
    ];
    let expected = "src/low/a.rs → src/low/deep/inner.rs → src/low/a.rs";
    assert_eq!(cycle(&files).as_deref(), Some(expected));
}

#[test]
fn a_parent_and_a_child_that_use_each_others_items_are_a_cycle() {
    let child = ("src/low/a.rs", "use super::Kind; pub struct A(Kind);");
    let parent = "mod a; pub use a::A; pub enum Kind { One } ";
    assert_eq!(cycle(&[child, ("src/low/mod.rs", parent)]), None, "it only re-exports A");
    let used = format!("{parent} fn all(_: &[A]) {{}}");
    let expected = Some("src/low/a.rs → src/low/mod.rs → src/low/a.rs");
    assert_eq!(cycle(&[child, ("src/low/mod.rs", &used)]).as_deref(), expected);
}

#[test]
fn a_name_of_both_a_module_and_a_function_means_the_function() {
    let files = [
        ("src/low/mod.rs", "mod arc; mod user; pub(crate) use arc::arc;"),
        ("src/low/arc.rs", "use crate::low::user; pub fn arc() { user::User::new() }"),
        ("src/low/user.rs", "use super::arc; pub struct User; fn f() { arc() }"),
    ];
    let expected = "src/low/arc.rs → src/low/user.rs → src/low/arc.rs";
    assert_eq!(cycle(&files).as_deref(), Some(expected));
}

#[test]
fn tests_comments_and_strings_import_nothing() {
    let files = [
        ("src/low/mod.rs", "mod a; mod b;"),
        ("src/low/a.rs", "use super::b::B; pub struct A<'a>(&'a B, char); const C: char = '\"';"),
        (
            "src/low/b.rs",
            r##"//! use super::a::A;
                /* use super::a::A; /* nested */ */
                pub struct B;
                const TEXT: &str = "\" use super::a::A;";
                const RAW: &str = r#"" use super::a::A;"#;
                #[cfg(test)]
                use super::{a::A, mod_b};
                #[cfg(test)]
                mod tests { use super::super::a::A; }
                #[test]
                fn a() { super::a::A; }
            "##,
        ),
    ];
    assert_eq!(cycle(&files), None);
}

#[test]
fn an_import_against_the_floors_is_found_with_its_line() {
    let lib = "//! | module | what it is |\n//! | --- | --- |\n//! | [`low`], `helper` | a |\n//! | `high` | b |\n";
    let floors = floors(lib);
    assert_eq!(floors, [vec!["low", "helper"], vec!["high"]]);
    let read = made_up(&[
        ("src/low/mod.rs", "mod a;\n\npub use crate::high::High;"),
        ("src/low/a.rs", "fn f() {\n    crate::high::f();\n}"),
        ("src/high/mod.rs", "mod inner; pub use inner::High; pub fn f() { crate::low::a::f() }"),
        ("src/high/inner.rs", "pub struct High;"),
    ]);
    let expected = [
        "src/low/a.rs:2 imports crate::high::f of src/high/mod.rs",
        "src/low/mod.rs:3 imports crate::high::High of src/high/inner.rs",
    ];
    assert_eq!(upward_imports(&read, &floors), expected);
}

#[test]
fn an_import_from_another_crate_that_the_root_re_exports_is_none() {
    let files = [
        ("src/lib.rs", "mod low; mod high; pub use other as kinematics;"),
        ("src/low/mod.rs", "use crate::kinematics::arm::Arm; pub struct Low(Arm);"),
    ];
    assert!(made_up(&files).imports().is_empty());
}
