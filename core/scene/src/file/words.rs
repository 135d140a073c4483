//! Messages of the derivation in the words of files: keys in the place of arguments and fields.

/// Words about programs, and what they are about in a file.
const WORDS: [(&str, &str); 9] = [
    (
        "declare what changes with it by `given(u = field)`, and go on by `step_with`",
        "what changes with it is prescribed by a program, with the library itself",
    ),
    ("the struct has no field", "this table has no key"),
    ("give it the type `NonstandardInertia` or `Inertia`", "write it as `{ tensor = [[…], […], […]] }`"),
    ("give it the type `NonstandardInertia`", "give it a name that ends in `_d`"),
    ("give it the type `Inertia`", "give it a name that doesn't end in `_d`"),
    (" of the struct", " of this table"),
    ("declare parts as terms of their own, and add them", "declare parts in tables of their own, `[[lagrangian]]`"),
    ("in a term of its own, and add it", "in a table of its own, `[[lagrangian]]`"),
    ("write the word `gradients` into the declaration, of each term", "no file has them"),
];

/// Types of fields, each with what a file has in its place; `#` is the number of rows.
const TYPES: [(&str, &str); 9] = [
    ("ContravariantVector", "a table { contravariant = […] }"),
    ("ContravariantTensor", "a table { contravariant = [[…], …] }"),
    ("CovariantTensor", "a table { covariant = [[…], …] }"),
    ("MixedTensor", "a table { mixed = [[…], …] }"),
    ("SVector", "a list of # numbers"),
    ("Vector", "a list of # numbers"),
    ("Point", "a table { point = […] } of # numbers"),
    ("SMatrix", "a matrix of # rows"),
    ("Matrix", "a matrix of # rows"),
];

/// A message with other words for a type, as `Vector3<f64>` or `SVector<f64, 7>`.
fn without_type(message: &str, name: &str, written: &str) -> String {
    let (mut all, mut rest) = (String::new(), message);
    while let Some(at) = rest.find(name) {
        let behind = &rest[at + name.len()..];
        let digits = |text: &str| text.chars().take_while(char::is_ascii_digit).collect::<String>();
        let own = digits(behind);
        let scalar = behind[own.len()..].strip_prefix("<f64");
        let arguments = scalar.and_then(|scalar| Some((scalar.split_once('>')?, own)));
        let Some(((argument, after), own)) = arguments else {
            let (before, later) = rest.split_at(at + name.len());
            all.push_str(before);
            rest = later;
            continue;
        };
        let rows = if own.is_empty() { digits(argument.trim_start_matches([',', ' '])) } else { own };
        all.extend([&rest[..at], &written.replace('#', &rows)]);
        rest = after;
    }
    all + rest
}

/// A message of the derivation in the words of files.
pub(crate) fn in_files(message: &str) -> String {
    let message = WORDS.iter().fold(message.to_owned(), |message, (program, file)| message.replace(program, file));
    let message = TYPES.iter().fold(message, |message, (name, written)| without_type(&message, name, written));
    let parts = message.split('`').enumerate();
    // Every second part is code.
    let parts = parts.map(|(number, part)| if number % 2 == 1 { key(part) } else { keys(part) });
    parts.collect::<Vec<_>>().join("`")
}

/// Words about fields as words about keys.
fn keys(text: &str) -> String {
    let word = |word: &str| match word.trim_end_matches([',', ':', ';', '.']) {
        "field" => word.replace("field", "key"),
        "fields" => word.replace("fields", "keys"),
        _ => word.to_owned(),
    };
    text.split(' ').map(word).collect::<Vec<_>>().join(" ")
}

/// An argument of a declaration as the key of a file: `group(F = SO3)` as `group = { F = "SO3" }`.
fn key(code: &str) -> String {
    let quoted = |text: &str| format!("\"{}\"", text.trim());
    if let Some((name, value)) = code.split_once(" = ")
        && ["group", "discretise", "velocity", "pace"].contains(&name)
    {
        return format!("{name} = {}", quoted(value));
    }
    let Some((name, inner)) = code.split_once('(').and_then(|(name, rest)| Some((name, rest.strip_suffix(')')?)))
    else {
        return code.to_owned();
    };
    match name {
        "group" | "advected" if inner.contains('=') => {
            let pair = |pair: &str| match pair.split_once('=') {
                Some((name, value)) => format!("{} = {}", name.trim(), quoted(value)),
                None => pair.trim().to_owned(),
            };
            format!("{name} = {{ {} }}", inner.split(',').map(pair).collect::<Vec<_>>().join(", "))
        }
        "advected" => name.to_owned(),
        "generators" => format!("generators = {{ {inner} }}"),
        "velocity" | "displacement" => format!("{name} = {}", quoted(inner)),
        _ => code.to_owned(),
    }
}
