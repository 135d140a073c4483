liestep::groups::matrix_group! {
    type Open = [[[0.0, 1.0], [0.0, 0.0]], [[0.0, 0.0], [1.0, 0.0]]];

    fn relation<T: nalgebra::RealField + Copy>(_: &nalgebra::SMatrix<T, 2, 2>) -> T {
        T::zero()
    }
}

fn main() {}
