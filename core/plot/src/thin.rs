//! Lines without points that can't be distinguished.

/// The tolerance in half pixels, invisible beside a line of usual width.
const TOLERANCE: f64 = 1.0;

/// A line reduced to as few points as describe it within half a pixel: the first, the last, and between two of these
/// the point farthest from their straight line, if it is too far (Ramer 1972; Douglas and Peucker 1973). `place` is the
/// position of a point in the drawing, in half pixels.
pub(super) fn thinned<P: Copy>(points: &[P], place: impl Fn(&P) -> (f64, f64)) -> Vec<P> {
    let places: Vec<_> = points.iter().map(place).collect();
    let mut kept = vec![false; places.len()];
    let mut stretches = vec![(0, places.len().saturating_sub(1))];
    while let Some((start, end)) = stretches.pop() {
        let Some([first, .., last] | [first @ last]) = places.get(start..=end) else {
            continue;
        };
        (kept[start], kept[end]) = (true, true);
        let inner = places.iter().enumerate().take(end).skip(start + 1);
        let farthest = inner.map(|(at, point)| (at, distance(point, first, last))).max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((at, distance)) = farthest
            && distance > TOLERANCE
        {
            stretches.extend([(start, at), (at, end)]);
        }
    }
    points.iter().zip(kept).filter_map(|(point, kept)| kept.then_some(*point)).collect()
}

/// The distance of a point from the segment between two others.
fn distance(point: &(f64, f64), first: &(f64, f64), last: &(f64, f64)) -> f64 {
    let (along, off) = ((last.0 - first.0, last.1 - first.1), (point.0 - first.0, point.1 - first.1));
    let squared = along.0 * along.0 + along.1 * along.1;
    let share = if squared > 0.0 { ((off.0 * along.0 + off.1 * along.1) / squared).clamp(0.0, 1.0) } else { 0.0 };
    (off.0 - share * along.0).hypot(off.1 - share * along.1)
}
