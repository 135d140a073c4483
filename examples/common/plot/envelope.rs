//! Fewer points for the same picture.

/// In each of `columns` equal parts of the horizontal range, only the lowest and the highest point, in their order:
/// what a line through all of them would cover. Points that aren't finite are left out.
pub(super) fn envelope(points: &[(f64, f64)], columns: u32) -> Vec<(f64, f64)> {
    let finite = || points.iter().copied().filter(|(x, y)| x.is_finite() && y.is_finite());
    let (Some(first), Some(last)) = (finite().next(), finite().next_back()) else {
        return Vec::new();
    };
    let width = (last.0 - first.0) / f64::from(columns);
    let mut kept = Vec::new();
    let mut column: Option<Column> = None;
    for point in finite() {
        match &mut column {
            Some(current) if point.0 < current.end => current.include(point),
            _ => {
                column.take().into_iter().for_each(|full| full.points(&mut kept));
                column = Some(Column { low: point, high: point, end: point.0 + width });
            }
        }
    }
    column.into_iter().for_each(|full| full.points(&mut kept));
    kept
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

    fn points(self, kept: &mut Vec<(f64, f64)>) {
        let (first, second) = if self.low.0 <= self.high.0 { (self.low, self.high) } else { (self.high, self.low) };
        kept.push(first);
        if second.0 > first.0 {
            kept.push(second);
        }
    }
}
