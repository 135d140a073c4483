//! The laws of a product of groups, of its retraction and of the parameters of several bodies. The reference is the
//! same group as block-diagonal matrices.

use core::array::from_fn;

use declarations::Alike;
use liestep::groups::{
    Advected, CayleyRetraction, Configuration, ContravariantVector, Factor, Heisenberg, LieGroup, Relative, Retraction,
    SE2, SE3, SL2, SeenFrom,
};
use liestep::laws::samples::{MatrixLieGroup, Random, derivative};
use liestep::mechanics::{Along, Between, Pairs, Places};
use liestep::numbers::{Blocks, Bodies, Entries, Mask};
use liestep::prelude::*;
use nalgebra::{DVector, Matrix3, Matrix6, SMatrix, SVector, Vector1, Vector3, Vector6};

type Product = (SO3, SE2);

/// The elements of the product as matrices with two blocks.
#[derive(Clone, Copy, Debug, PartialEq)]
struct BlockMatrix(Matrix6<f64>);

fn blocks(matrix: &Matrix6<f64>) -> (Matrix3<f64>, Matrix3<f64>) {
    (matrix.fixed_view::<3, 3>(0, 0).into_owned(), matrix.fixed_view::<3, 3>(3, 3).into_owned())
}

fn matrix((first, second): &(Matrix3<f64>, Matrix3<f64>)) -> Matrix6<f64> {
    let mut matrix = Matrix6::zeros();
    matrix.fixed_view_mut::<3, 3>(0, 0).copy_from(first);
    matrix.fixed_view_mut::<3, 3>(3, 3).copy_from(second);
    matrix
}

impl BlockMatrix {
    fn product(&self) -> Product {
        Product::from_matrix_unchecked(blocks(&self.0))
    }

    fn of(product: &Product) -> Self {
        Self(matrix(&product.matrix()))
    }
}

impl LieGroup for BlockMatrix {
    type Scalar = f64;
    type Vector = Vector6<f64>;
    type Matrix = Matrix6<f64>;

    const DIMENSION: usize = Product::DIMENSION;
    const FACTORS: Blocks = Product::FACTORS;

    fn identity() -> Self {
        Self::of(&Product::identity())
    }

    fn compose(&self, right: &Self) -> Self {
        Self::of(&self.product().compose(&right.product()))
    }

    fn inverse(&self) -> Self {
        Self::of(&self.product().inverse())
    }

    fn matrix(&self) -> Matrix6<f64> {
        self.0
    }

    fn from_matrix_unchecked(matrix: Matrix6<f64>) -> Self {
        Self(matrix)
    }

    fn hat(components: &Vector6<f64>) -> Matrix6<f64> {
        matrix(&Product::hat(components))
    }

    fn vee(matrix: &Matrix6<f64>) -> Vector6<f64> {
        Product::vee(&blocks(matrix))
    }

    fn adjoint(&self, velocity: &Vector6<f64>) -> Vector6<f64> {
        self.product().adjoint(velocity)
    }

    fn adjoint_transpose(&self, momentum: &Vector6<f64>) -> Vector6<f64> {
        self.product().adjoint_transpose(momentum)
    }

    fn lie_bracket(xi: &Vector6<f64>, eta: &Vector6<f64>) -> Vector6<f64> {
        Product::lie_bracket(xi, eta)
    }

    fn lie_bracket_transpose(xi: &Vector6<f64>, momentum: &Vector6<f64>) -> Vector6<f64> {
        Product::lie_bracket_transpose(xi, momentum)
    }

    fn from_increment(increment: &Matrix6<f64>) -> Self {
        let across = increment - matrix(&blocks(increment));
        Self(Self::of(&Product::from_increment(&blocks(increment))).0 + across)
    }

    fn increment(&self) -> Matrix6<f64> {
        matrix(&self.product().increment())
    }

    fn inverse_increment(increment: &Matrix6<f64>) -> Matrix6<f64> {
        matrix(&Product::inverse_increment(&blocks(increment)))
    }

    fn change(&self, increment: &Matrix6<f64>) -> Matrix6<f64> {
        matrix(&self.product().change(&blocks(increment)))
    }

    fn advance(&self, increment: &Matrix6<f64>) -> Self {
        Self::of(&self.product().advance(&blocks(increment)))
    }

    fn adjoint_transpose_increment(increment: &Matrix6<f64>, momentum: &Vector6<f64>) -> Vector6<f64> {
        Product::adjoint_transpose_increment(&blocks(increment), momentum)
    }

    fn defect(&self) -> f64 {
        self.product().defect() + (self.0 - matrix(&blocks(&self.0))).norm()
    }
}

/// The product's own Cayley map.
struct ProductCayley;

impl Retraction<BlockMatrix> for ProductCayley {
    fn increment(xi: &Vector6<f64>) -> Matrix6<f64> {
        matrix(&<CayleyRetraction as Retraction<Product>>::increment(xi))
    }

    fn local_coordinates(element: &BlockMatrix) -> Option<Vector6<f64>> {
        <CayleyRetraction as Retraction<Product>>::local_coordinates(&element.product())
    }

    fn tangent(xi: &Vector6<f64>) -> Matrix6<f64> {
        <CayleyRetraction as Retraction<Product>>::tangent(xi)
    }

    fn is_near(xi: &Vector6<f64>, times: f64) -> Mask<f64> {
        <CayleyRetraction as Retraction<Product>>::is_near(xi, times)
    }
}

mod group {
    liestep::lie_group_laws!(super::BlockMatrix);
}

mod retraction {
    liestep::retraction_laws!(super::BlockMatrix, super::ProductCayley);
}

/// Each body is tested separately for nearness to the identity.
#[test]
fn a_product_is_near_where_all_its_factors_are() {
    let near = |x: f64, y: f64| {
        let xi = Vector6::new(x, 0.0, 0.0, y, 0.0, 0.0);
        <CayleyRetraction as Retraction<(SO3, SO3)>>::is_near_identity(&xi)
    };
    assert!(near(1.9, 1.9) && !near(2.1, 0.0) && !near(0.0, 2.1));
    let of_many = |x: f64, y: f64| {
        let xi = Bodies([Vector3::x() * x, Vector3::zeros(), Vector3::y() * y]);
        let half = Bodies(xi.0.map(|xi| xi * 0.5));
        let [whole, half] = [
            <CayleyRetraction as Retraction<[SO3; 3]>>::is_near_identity(&xi),
            <CayleyRetraction as Retraction<[SO3; 3]>>::is_half_near_identity(&half),
        ];
        assert_eq!(whole, half);
        whole
    };
    assert!(of_many(1.9, 1.9) && !of_many(2.1, 0.0) && !of_many(0.0, 2.1));
}

/// If rounding has moved one factor off the group, the other factor stays unchanged.
#[test]
fn what_is_far_is_restored_by_itself() {
    let good = SO3::from(nalgebra::UnitQuaternion::from_scaled_axis(Vector3::new(0.3, -0.4, 0.9)));
    let bad = SO3::from_matrix_unchecked(good.matrix() * (1.0 + 1e-9));
    assert!((good, good).restored(2048.0).is_none());
    let (restored, _) = (good, bad).restored(2048.0).unwrap();
    assert_eq!(restored.0, good);
    assert!(restored.1.defect() < 1e-15 && (good, bad).defect() > 1e-9);
}

type Four = (SO3, SE2, SO3, SE2);

/// Three and four factors are in the order of the tuple, and so are their components.
#[test]
fn components_are_in_the_order_of_the_factors() {
    type Three = (SO3, SE2, SO3);
    let xi = SMatrix::<f64, 9, 1>::from_fn(|k, _| f64::from(u8::try_from(k).unwrap()));
    assert_eq!(<Three as Factor<1>>::components(&xi), Vector3::new(3.0, 4.0, 5.0));
    assert_eq!(Three::hat(&xi).2, SO3::hat(&Vector3::new(6.0, 7.0, 8.0)));
    assert_eq!(Three::vee(&Three::hat(&xi)), xi);
    assert!(Three::FACTORS.end_at(3) && Three::FACTORS.end_at(6) && !Three::FACTORS.end_at(4));
    let xi = SMatrix::<f64, 12, 1>::from_fn(|k, _| f64::from(u8::try_from(k).unwrap()));
    assert_eq!(<Four as Factor<3>>::components(&xi), Vector3::new(9.0, 10.0, 11.0));
    assert_eq!(Four::vee(&Four::hat(&xi)), xi);
    assert_eq!(Four::DIMENSION, 12);
    let f = <CayleyRetraction as Retraction<Four>>::retract(&(xi * 0.05));
    let back = <CayleyRetraction as Retraction<Four>>::local_coordinates(&f).unwrap();
    assert!((back - xi * 0.05).norm() < 1e-14);
}

/// The columns of a group's elements, with their units.
fn columns<G: LieGroup>() -> Vec<String> {
    let columns = G::factors().into_iter().flat_map(|factor| factor.columns());
    columns.map(|(name, unit)| format!("{name} {unit}")).collect()
}

/// The columns of translations in a table are their vectors.
#[test]
fn numbers_of_translations() {
    let names = columns::<(SO3, R1, R3)>();
    assert_eq!(names.join(","), "q_w_1 1,q_x_1 1,q_y_1 1,q_z_1 1,x_2 m,x_3 m,y_3 m,z_3 m");
    let (line, space) = (R1::from(Vector1::new(5.0)), R3::from(Vector3::new(6.0, 7.0, 8.0)));
    let mut numbers = [0.0; 9];
    assert_eq!((SO3::identity(), line, space).write_numbers(&mut numbers).len(), 1);
    assert_eq!(numbers.map(f64::to_bits), [1.0, 0.0, 0.0, 0.0, 5.0, 6.0, 7.0, 8.0, 0.0].map(f64::to_bits));
    let read: f64 = line.value();
    assert_eq!(read.to_bits(), 5.0_f64.to_bits());
}

/// In a table the factors follow each other.
#[test]
fn numbers_of_a_product_are_those_of_its_factors() {
    let names = columns::<Product>();
    let expected = "q_w_1 1,q_x_1 1,q_y_1 1,q_z_1 1,\
        g_11_2 ,g_12_2 ,g_13_2 ,g_21_2 ,g_22_2 ,g_23_2 ,g_31_2 ,g_32_2 ,g_33_2 ";
    assert_eq!(names.join(","), expected);
    let components = Product::factors().into_iter().flat_map(|factor| factor.components);
    let components: Vec<_> = components.map(|(name, units)| (name, units[0])).collect();
    let expected = [("x_1", "rad/s"), ("y_1", "rad/s"), ("z_1", "rad/s"), ("1_2", ""), ("2_2", ""), ("3_2", "")];
    assert_eq!(components, expected.map(|(name, unit)| (name.to_owned(), unit)));

    let second = SE2::from_matrix_unchecked(Matrix3::new(0.6, -0.8, 3.0, 0.8, 0.6, 4.0, 0.0, 0.0, 1.0));
    // The quaternion of the previous row had the opposite sign.
    let mut numbers = [0.0; 14];
    numbers[0] = -1.0;
    assert_eq!((SO3::identity(), second).write_numbers(&mut numbers).len(), 1);
    let expected: [f64; 14] = [-1.0, 0.0, 0.0, 0.0, 0.6, -0.8, 3.0, 0.8, 0.6, 4.0, 0.0, 0.0, 1.0, 0.0];
    assert!(numbers.iter().zip(expected).all(|(number, expected)| (number - expected).abs() < 1e-15), "{numbers:?}");
}

fn entries(of: &impl Entries<f64>) -> Vec<f64> {
    let mut entries = Vec::new();
    of.each(&mut |entry| entries.push(entry));
    entries
}

/// The value in the frame of matrices with this number of factors and their inverses, from that in space.
type TypedValue<'a, const K: usize> = dyn Fn(&[f64], &[Matrix3<f64>; K], &[Matrix3<f64>; K]) -> Vec<f64> + 'a;

/// Compares all functions of a parameter with `typed`, its value in the frame of these matrices and inverses.
fn assert_seen<G, A, const K: usize>(
    together: fn([Matrix3<f64>; K]) -> G::Matrix,
    element: fn(&mut Random) -> [Matrix3<f64>; K],
    typed: &TypedValue<'_, K>,
) where
    G: LieGroup<Scalar = f64>,
    A: Advected<G>,
{
    let random = &mut Random::new(51);
    for _ in 0..5 {
        // The bound is some thousand roundings, for numbers of the size of ten and inverses of random matrices; slopes
        // by differences lose two more digits.
        let close = |what: &str, found: &A, expected: &[f64], allowed: f64| {
            let off = entries(found).iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(entries(found).len() == expected.len() && off < allowed, "{what}: off by {off:e}");
        };
        let spatial: A = random.sample();
        let numbers = entries(&spatial);
        let at = |m: &[Matrix3<f64>; K]| typed(&numbers, m, &m.map(|m| m.try_inverse().unwrap()));
        let (g, f) = (element(random), element(random));
        let attitude = G::from_matrix_unchecked(together(g));
        let seen = spatial.seen_from(&attitude);
        close("seen", &seen, &at(&g), 1e-12);

        let both = from_fn(|k| g[k] * f[k]);
        let increment = together(f.map(|f| f - Matrix3::identity()));
        let change: Vec<f64> = at(&both).iter().zip(at(&g)).map(|(after, before)| after - before).collect();
        close("advected", &seen.advect(&increment), &at(&both), 1e-12);
        close("change", &seen.change(&increment), &change, 1e-12);

        // The matrices are arbitrary: no transpose is an inverse, and none is the inverse of another.
        let mut any = || [(); K].map(|()| random.sample::<Matrix3<f64>>());
        let [m, n, x] = [any(), any(), any()];
        close("through", &spatial.seen_through(&together(m), &together(n)), &typed(&numbers, &m, &n), 1e-12);
        let along = |t: f64| DVector::from_vec(at(&from_fn(|k| g[k] * (Matrix3::identity() + x[k] * t))));
        close("rate", &seen.rate(&together(x)), derivative(along).as_slice(), 1e-10);

        let by: A = random.sample();
        let inverses = g.map(|g| g.try_inverse().unwrap());
        let of_unit = |number: usize| {
            let unit: Vec<f64> = (0..numbers.len()).map(|k| f64::from(u8::from(k == number))).collect();
            typed(&unit, &g, &inverses).iter().zip(entries(&by)).map(|(seen, by)| seen * by).sum()
        };
        let pulled: Vec<f64> = (0..numbers.len()).map(of_unit).collect();
        close("pulled back", &by.pulled_back(&attitude), &pulled, 1e-12);
    }
}

fn rotation(random: &mut Random) -> Matrix3<f64> {
    random.element::<SO3, 3, 3>().matrix()
}

fn read(numbers: &[f64], place: usize) -> Matrix3<f64> {
    Matrix3::from_row_slice(&numbers[9 * place..9 * place + 9])
}

fn written(matrices: impl IntoIterator<Item = Matrix3<f64>>) -> Vec<f64> {
    matrices.into_iter().flat_map(|matrix| matrix.transpose().as_slice().to_vec()).collect()
}

/// The parameters of four bodies, two of them with matrices that aren't orthogonal, in either order.
#[test]
fn what_bodies_of_a_product_see() {
    fn of_four<A: Advected<Four>>(typed: &TypedValue<'_, 4>) {
        let element = |random: &mut Random| {
            let mut motion = || random.element::<SE2, 3, 3>().matrix();
            let (second, fourth) = (motion(), motion());
            [rotation(random), second, rotation(random), fourth]
        };
        assert_seen::<Four, A, 4>(|[a, b, c, d]| (a, b, c, d), element, typed);
    }
    type Square = Matrix3<f64>;
    let vector = Vector3::from_column_slice;
    of_four::<SeenFrom<0, Vector3<f64>>>(&|w, m, _| (m[0].transpose() * vector(w)).as_slice().to_vec());
    of_four::<SeenFrom<3, Vector3<f64>>>(&|w, m, _| (m[3].transpose() * vector(w)).as_slice().to_vec());
    of_four::<SeenFrom<1, ContravariantVector<f64, 3>>>(&|w, _, n| (n[1] * vector(w)).as_slice().to_vec());
    of_four::<Relative<1, 3, Square>>(&|w, m, n| written([n[1] * read(w, 0) * m[3]]));
    of_four::<Relative<3, 1, Square>>(&|w, m, n| written([n[3] * read(w, 0) * m[1]]));
    of_four::<Relative<2, 0, Square>>(&|w, m, n| written([n[2] * read(w, 0) * m[0]]));
    of_four::<Configuration<1, Square>>(&|w, m, _| written([read(w, 0) * m[1]]));
    of_four::<Configuration<2, Square>>(&|w, m, _| written([read(w, 0) * m[2]]));
    of_four::<(Configuration<3, Square>, Relative<0, 2, Square>)>(&|w, m, n| {
        written([read(w, 0) * m[3], n[0] * read(w, 1) * m[2]])
    });
}

/// The parameters of three equal bodies: of each, of one, and at the places of two.
#[test]
fn what_bodies_of_an_array_see() {
    type At<P> = <P as Places<Alike>>::Advected;
    fn of_three<A: Advected<[SO3; 3]>>(typed: &TypedValue<'_, 3>) {
        let element = |random: &mut Random| [(); 3].map(|()| rotation(random));
        assert_seen::<[SO3; 3], A, 3>(|all| all, element, typed);
    }
    of_three::<At<Along<3>>>(&|w, m, n| {
        // The entry after the two neighbours is padding.
        written([n[0] * read(w, 0) * m[1], n[1] * read(w, 1) * m[2], read(w, 2)])
    });
    of_three::<At<Between<2, 0, 3>>>(&|w, m, n| written([n[2] * read(w, 0) * m[0]]));
    of_three::<At<Between<1, 2, 3>>>(&|w, m, n| written([n[1] * read(w, 0) * m[2]]));
    of_three::<At<Pairs<3>>>(&|w, m, _| written([0, 1, 2].map(|k| read(w, k) * m[k])));
    of_three::<SeenFrom<2, Vector3<f64>>>(&|w, m, _| {
        (m[2].transpose() * Vector3::from_column_slice(w)).as_slice().to_vec()
    });

    let element = |random: &mut Random| [(); 3].map(|()| random.element::<SE2, 3, 3>().matrix());
    let each = |w: &[f64], by: &[Matrix3<f64>; 3]| {
        (0..3).flat_map(|k| (by[k] * Vector3::from_column_slice(&w[3 * k..3 * k + 3])).as_slice().to_vec()).collect()
    };
    let covectors = |w: &[f64], m: &[Matrix3<f64>; 3], _: &_| each(w, &m.map(|m| m.transpose()));
    assert_seen::<[SE2; 3], [Vector3<f64>; 3], 3>(|all| all, element, &covectors);
    let vectors = |w: &[f64], _: &_, n: &[Matrix3<f64>; 3]| each(w, n);
    assert_seen::<[SE2; 3], [ContravariantVector<f64, 3>; 3], 3>(|all| all, element, &vectors);
}

type NotOrthogonal = (SE2, SE3, SL2, Heisenberg);

/// P3: for each factor `Fᵀ w` preserves the pairing with a vector, and `F⁻¹ w` doesn't.
#[test]
fn p3_covectors_of_each_factor() {
    fn p3<const K: usize, const N: usize, const D: usize>()
    where
        NotOrthogonal: Factor<K, Of: MatrixLieGroup<N, D>>,
    {
        let random = &mut Random::new(31);
        let (mut right, mut naive) = (0.0_f64, 0.0_f64);
        for _ in 0..20 {
            let f = (random.element::<SE2, _, _>(), random.element(), random.element(), random.element());
            let (w, v): (SVector<f64, N>, SVector<f64, N>) = (random.sample(), random.sample());
            let d = LieGroup::increment(&f);
            let seen = Advected::<NotOrthogonal>::advect(&SeenFrom::<K, _>(w), &d).0;
            let moved = Advected::<NotOrthogonal>::advect(&SeenFrom::<K, _>(ContravariantVector(v)), &d).0.0;
            let matrix = <NotOrthogonal as Factor<K>>::factor(&f).matrix();
            let inverse = matrix.try_inverse().unwrap();
            right = right.max((seen - matrix.transpose() * w).amax()).max((moved - inverse * v).amax());
            right = right.max((seen.dot(&moved) - w.dot(&v)).abs());
            naive = naive.max(((inverse * w).dot(&moved) - w.dot(&v)).abs());
        }
        // The bound is some products of matrices with entries below ten.
        println!("factor {K}: {right:.1e}, by F⁻¹ w {naive:.1e}");
        assert!(right < 1e-13 && naive > 0.1, "factor {K}: {right:e} {naive:e}");
    }
    p3::<0, 3, 3>();
    p3::<1, 4, 6>();
    p3::<2, 2, 3>();
    p3::<3, 3, 3>();
}
