//! `schema`: the JSON schemas of all JSON that squinch reads and writes.

use super::{Halt, batch, files};
use clap::{Args, ValueEnum};
use serde_json::{Value, json};
use squinch::import::outline;
use squinch::run::Exit;
use squinch::run::report::{Report, schema_of};

/// The JSON schemas of outlines, reports and batch lines
#[derive(Args)]
pub struct Schema {
    /// Which schema; all of them under their names where none is named
    #[arg(value_enum, value_name = "WHICH")]
    which: Option<Which>,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Which {
    /// Outlines, which are read
    Outline,
    /// The report of a run
    Report,
    /// A line of a batch
    Batch,
}

impl Schema {
    /// Prints the schemas.
    pub fn run(self) -> Result<Exit, Halt> {
        let schemas = match self.which {
            Some(which) => which.schema(),
            None => json!({
                "outline": Which::Outline.schema(),
                "report": Which::Report.schema(),
                "batch": Which::Batch.schema(),
            }),
        };
        files::print(&format!("{schemas:#}\n"))?;
        Ok(Exit::Done)
    }
}

impl Which {
    fn schema(self) -> Value {
        match self {
            Self::Outline => serde_json::from_str(outline::SCHEMA).expect("the schema of outlines is JSON"),
            Self::Report => schema_of::<Report>(),
            Self::Batch => schema_of::<batch::Line>(),
        }
    }
}
