//! Fewer points for the same picture. Points that aren't finite are left out.

/// The highest point in each of `columns` equal parts of the horizontal range, as deviations matter by their peaks.
pub(super) fn crest(points: &[(f64, f64)], columns: u32) -> Vec<(f64, f64)> {
    split(points, columns).into_iter().map(|column| column.high).collect()
}

/// The lowest and the highest point in each of `columns` equal parts of the horizontal range, in their order: they
/// cover what a line through all points covers.
pub(super) fn envelope(points: &[(f64, f64)], columns: u32) -> Vec<(f64, f64)> {
    split(points, columns).into_iter().flat_map(Column::points).collect()
}

fn split(points: &[(f64, f64)], columns: u32) -> Vec<Column> {
    let finite = || points.iter().copied().filter(|(x, y)| x.is_finite() && y.is_finite());
    let (Some(first), Some(last)) = (finite().next(), finite().next_back()) else {
        return Vec::new();
    };
    let width = (last.0 - first.0) / f64::from(columns);
    let mut split: Vec<Column> = Vec::new();
    for point in finite() {
        match split.last_mut() {
            Some(column) if point.0 < column.end => column.include(point),
            _ => split.push(Column { low: point, high: point, end: point.0 + width }),
        }
    }
    split
}

struct Column {
    low: (f64, f64),
    high: (f64, f64),
    end: f64,
}

impl Column {
    fn include(&mut self, point: (f64, f64)) {
        if point.1 < self.low.1 {
            self.low = point;
        }
        if point.1 > self.high.1 {
            self.high = point;
        }
    }

    fn points(self) -> impl Iterator<Item = (f64, f64)> {
        let (first, second) = if self.low.0 <= self.high.0 { (self.low, self.high) } else { (self.high, self.low) };
        std::iter::once(first).chain((second.0 > first.0).then_some(second))
    }
}
