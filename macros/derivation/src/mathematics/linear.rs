//! Linear algebra of small matrices of numbers.

/// The generators of a group have decimals, and so few products that roundings stay far below.
pub const ROUNDING: f64 = 1e-9;

/// The reduced echelon form of these rows, and the columns of its pivots.
fn echelon(mut rows: Vec<Vec<f64>>, columns: usize) -> (Vec<Vec<f64>>, Vec<usize>) {
    let mut pivots = Vec::new();
    for column in 0..columns {
        let done = pivots.len();
        let largest = (done..rows.len()).max_by(|&a, &b| rows[a][column].abs().total_cmp(&rows[b][column].abs()));
        let Some(largest) = largest.filter(|&row| rows[row][column].abs() > ROUNDING) else { continue };
        rows.swap(done, largest);
        let pivot = rows[done][column];
        rows[done].iter_mut().for_each(|entry| *entry /= pivot);
        let reference = rows[done].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|(at, row)| *at != done && row[column] != 0.0) {
            let factor = row[column];
            row.iter_mut().zip(&reference).for_each(|(entry, of)| *entry -= factor * of);
        }
        pivots.push(column);
    }
    (rows, pivots)
}

/// A basis of the vectors that these rows are orthogonal to.
pub fn kernel(rows: Vec<Vec<f64>>, columns: usize) -> Vec<Vec<f64>> {
    let (rows, pivots) = echelon(rows, columns);
    let free = (0..columns).filter(|column| !pivots.contains(column));
    let of_free = |free: usize| {
        let mut vector = vec![0.0; columns];
        vector[free] = 1.0;
        for (row, &pivot) in rows.iter().zip(&pivots) {
            vector[pivot] = -row[free];
        }
        vector
    };
    free.map(of_free).collect()
}

/// The inverse of a matrix, row by row; `None` if it is singular.
pub fn inverse_of(size: usize, matrix: &[f64]) -> Option<Vec<f64>> {
    let beside = |i: usize| (0..size).map(move |j| f64::from(u8::from(i == j)));
    let rows = matrix.chunks(size).enumerate().map(|(i, row)| row.iter().copied().chain(beside(i)).collect()).collect();
    let (rows, pivots) = echelon(rows, size);
    (pivots.len() == size).then(|| rows.into_iter().flat_map(|row| row[size..].to_vec()).collect())
}
