//! Rotations and rigid motions `[R, X; 0, I]` in the library's basis, whose Cayley map has a closed form.
//!
//! Half the coordinates are `y` of the rotation, then a column `x` for each column beside it. With the increment
//! `S = (ŷ + ŷ²) · 2/(1 + |y|²)` of the rotation `(I − ŷ)⁻¹ = I + S/2`, so that
//!
//! ```text
//! F − I   = [S, 2x + Sx; 0, 0]
//! F⁻¹ − I = [Sᵀ, −(t + Sᵀt); 0, 0]                      for the column t of F − I
//! T       = [t(y), 0; x × t(y), 2I + S]                 for the tangent t(y) of the rotation
//! Ad*_F − 1: (m, f) ↦ (Sᵀ(m − t × f) − t × f, Sᵀf)
//! ```

use super::matrix::Matrix;
use super::values::{Value, Words};

/// The number of rotations of this many rows.
pub(super) const fn turns(rows: usize) -> usize {
    rows * (rows - 1) / 2
}

/// `2/(1 + y·y)`, and its products with half the Cayley coordinates.
fn scaled(words: &mut Words, half: &[Value]) -> (Value, Vec<Value>) {
    let square = words.dot(half, half);
    let one = words.add(Value::ONE, square);
    let scale = words.divide(Value::of(2.0), one);
    (scale, half.iter().map(|&entry| words.multiply(scale, entry)).collect())
}

/// The columns of the tangent of a rotation, `(I + ŷ) 2/(1 + y·y)`; in the plane it is a number.
pub(super) fn tangent_of_rotation(words: &mut Words, half: &[Value]) -> Vec<Vec<Value>> {
    let (scale, products) = scaled(words, half);
    let &[x, y, z] = products.as_slice() else { return vec![vec![scale]] };
    let [minus_x, minus_y, minus_z] = [x, y, z].map(|entry| words.negate(entry));
    vec![vec![scale, z, minus_y], vec![minus_z, scale, x], vec![y, minus_x, scale]]
}

/// `F − I` of half the Cayley coordinates of a rotation of space or of the plane.
pub(super) fn rotation(words: &mut Words, half: &[Value]) -> Matrix {
    let (_, products) = scaled(words, half);
    let (&[x, y, z], &[bx, by, bz]) = (half, products.as_slice()) else {
        let square = words.multiply(products[0], half[0]);
        let (shorter, turned) = (words.negate(square), words.negate(products[0]));
        return Matrix { rows: 2, columns: 2, entries: vec![shorter, turned, products[0], shorter] };
    };
    let [xx, yy, zz] = [(bx, x), (by, y), (bz, z)].map(|(a, b)| words.multiply(a, b));
    let [xy, xz, yz] = [(bx, y), (bx, z), (by, z)].map(|(a, b)| words.multiply(a, b));
    let [xx, yy, zz] = [(yy, zz), (xx, zz), (xx, yy)].map(|(a, b)| {
        let sum = words.add(a, b);
        words.negate(sum)
    });
    let entries = vec![
        xx,
        words.subtract(xy, bz),
        words.add(xz, by),
        words.add(xy, bz),
        yy,
        words.subtract(yz, bx),
        words.subtract(xz, by),
        words.add(yz, bx),
        zz,
    ];
    Matrix { rows: 3, columns: 3, entries }
}

/// `a × b`; in the plane it is a number.
fn cross(words: &mut Words, a: &[Value], b: &[Value]) -> Vec<Value> {
    let mut minor = |i: usize, j: usize| {
        let (p, q) = (words.multiply(a[i], b[j]), words.multiply(a[j], b[i]));
        words.subtract(p, q)
    };
    if a.len() == 2 { vec![minor(0, 1)] } else { vec![minor(1, 2), minor(2, 0), minor(0, 1)] }
}

/// The matrix with these columns, each of the rows of the rotation, and zeros below.
fn above(size: usize, columns: &[Vec<Value>]) -> Matrix {
    Matrix::of(size, size, |i, j| columns[j].get(i).copied().unwrap_or(Value::ZERO))
}

/// `F − I` of half the coordinates, for rotations of `rows` rows in matrices of `size`.
pub(super) fn increment(words: &mut Words, [rows, size]: [usize; 2], half: &[Value]) -> Matrix {
    let (y, beside) = half.split_at(turns(rows));
    let turned = rotation(words, y);
    let mut columns: Vec<Vec<Value>> = (0..rows).map(|j| turned.column(j)).collect();
    for x in beside.chunks(rows) {
        let twice = words.added(x, x);
        let moved: Vec<Value> = (0..rows).map(|i| words.dot(turned.row(i), x)).collect();
        columns.push(words.added(&twice, &moved));
    }
    above(size, &columns)
}

/// `F⁻¹ − I` of `F − I`.
pub(super) fn inverse_increment(words: &mut Words, rows: usize, d: &Matrix) -> Matrix {
    let upper = |j: usize| d.column(j)[..rows].to_vec();
    let mut columns: Vec<Vec<Value>> = (0..rows).map(|j| d.row(j)[..rows].to_vec()).collect();
    for place in (rows..d.columns).map(upper) {
        let column = (0..rows).map(|i| {
            let moved = words.dot(&upper(i), &place);
            let sum = words.add(place[i], moved);
            words.negate(sum)
        });
        columns.push(column.collect());
    }
    above(d.rows, &columns)
}

/// The tangent by half the coordinates, column by column.
pub(super) fn tangent(words: &mut Words, rows: usize, half: &[Value]) -> Vec<Vec<Value>> {
    let (y, beside) = half.split_at(turns(rows));
    let mut columns = tangent_of_rotation(words, y);
    for column in &mut columns {
        let turning = column.clone();
        for x in beside.chunks(rows) {
            match turning.as_slice() {
                &[turning] => {
                    let (first, second) = (words.multiply(x[1], turning), words.multiply(x[0], turning));
                    column.extend([first, words.negate(second)]);
                }
                turning => column.extend(cross(words, x, turning)),
            }
        }
    }
    let turned = rotation(words, y);
    for at in 0..beside.len() {
        let mut column = vec![Value::ZERO; half.len()];
        for (i, &entry) in turned.column(at % rows).iter().enumerate() {
            let place = y.len() + at / rows * rows + i;
            column[place] = if i == at % rows { words.add(Value::of(2.0), entry) } else { entry };
        }
        columns.push(column);
    }
    columns
}

/// `Ad*_F μ − μ` of `F − I`.
pub(super) fn coadjoint_change(words: &mut Words, rows: usize, d: &Matrix, mu: &[Value]) -> Vec<Value> {
    let upper = |j: usize| d.column(j)[..rows].to_vec();
    let (moment, forces) = mu.split_at(turns(rows));
    let mut arms = vec![Value::ZERO; moment.len()];
    for (k, force) in forces.chunks(rows).enumerate() {
        let arm = cross(words, &upper(rows + k), force);
        arms = words.added(&arms, &arm);
    }
    let mut change = if rows == 2 {
        arms.iter().map(|&arm| words.negate(arm)).collect()
    } else {
        let rest = words.subtracted(moment, &arms);
        let turned: Vec<Value> = (0..rows).map(|i| words.dot(&upper(i), &rest)).collect();
        words.subtracted(&turned, &arms)
    };
    for force in forces.chunks(rows) {
        change.extend((0..rows).map(|i| words.dot(&upper(i), force)));
    }
    change
}
