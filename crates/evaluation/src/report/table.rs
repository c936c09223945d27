//! Tables: Markdown for pages, aligned so that it reads well on a terminal too.

use std::fmt;

/// Rows under a header; [`Display`](fmt::Display) writes Markdown.
#[derive(Debug, Clone)]
pub struct Table {
    /// The header first.
    rows: Vec<Vec<String>>,
}

impl Table {
    /// No rows yet.
    pub fn new<T: ToString>(header: impl IntoIterator<Item = T>) -> Self {
        Self { rows: vec![header.into_iter().map(|cell| cell.to_string()).collect()] }
    }

    /// Adds a row.
    ///
    /// # Panics
    /// When it has not as many cells as the header.
    pub fn row<T: ToString>(&mut self, cells: impl IntoIterator<Item = T>) {
        let cells: Vec<String> = cells.into_iter().map(|cell| cell.to_string()).collect();
        assert_eq!(cells.len(), self.rows[0].len(), "cells of a row under {:?}", self.rows[0]);
        self.rows.push(cells);
    }
}

impl fmt::Display for Table {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let width = |column: usize| self.rows.iter().map(|row| row[column].chars().count()).max();
        let widths: Vec<usize> =
            (0..self.rows[0].len()).map(|column| width(column).unwrap_or(0).max(3)).collect();
        for (number, row) in self.rows.iter().enumerate() {
            for (cell, width) in row.iter().zip(&widths) {
                write!(out, "| {cell:<width$} ")?;
            }
            writeln!(out, "|")?;
            if number == 0 {
                for width in &widths {
                    write!(out, "| {:-<width$} ", "")?;
                }
                writeln!(out, "|")?;
            }
        }
        Ok(())
    }
}

/// A probability with the digits that mean something.
pub fn probability(p: f64) -> String {
    if p == 0.0 || p >= 1e-3 { format!("{p:.3}") } else { format!("{p:.0e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_as_wide_as_their_widest_cell() {
        let mut table = Table::new(["a", "label"]);
        table.row(["1,234", "±"]);
        assert_eq!(table.to_string(), "| a     | label |\n| ----- | ----- |\n| 1,234 | ±     |\n");
    }
}
