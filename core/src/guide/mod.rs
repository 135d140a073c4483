#![doc = include_str!("README.md")]
#![allow(clippy::doc_markdown)] // names of authors and of libraries are not code

/// The chapters, each of the Markdown file of its name.
macro_rules! chapters {
    ($($chapter:ident)*) => {$(
        pub mod $chapter {
            #![doc = include_str!(concat!(stringify!($chapter), ".md"))]
        }
    )*};
}

chapters! {
    accuracy bodies conserved effects ensembles files first_program gradients groups hard_cases inside late recording thesis
}
