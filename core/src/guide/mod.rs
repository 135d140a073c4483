#![doc = include_str!("README.md")]
#![allow(clippy::doc_markdown)] // names of authors and of libraries are not code

/// The chapters, each of the Markdown file of its name, some with a picture at their ends.
macro_rules! chapters {
    ($($chapter:ident $($figure:literal)?)*) => {$(
        pub mod $chapter {
            #![doc = include_str!(concat!(stringify!($chapter), ".md"))]
            $(
                #![doc = "<style>.docblock svg { max-width: 100%; height: auto; }</style>\n"]
                #![doc = include_str!(concat!("../figures/", $figure, ".svg"))]
            )?
        }
    )*};
}

chapters! {
    accuracy bodies "hanging-chain" conserved "3-8" control effects "satellite" ensembles files first_program "moving-top" gradients groups hard_cases inside late recording rolling satellite thesis varying
}
