/* A polynomial by Horner's rule in the fourth power of its argument: the order of operations of the library. */
FUNCTION double $chain(POINTER coefficients, int count, int first, double fourth) {
    int at = first + (count - 1 - first) / 4 * 4;
    double sum = coefficients[at];
    while ((at -= 4) >= first) sum = sum * fourth + coefficients[at];
    return sum;
}

FUNCTION double $polynomial(POINTER coefficients, int count, double x) {
    const double square = x * x, fourth = square * square;
    const double even = $chain(coefficients, count, 0, fourth) + $chain(coefficients, count, 2, fourth) * square;
    const double odd = $chain(coefficients, count, 1, fourth) + $chain(coefficients, count, 3, fourth) * square;
    return even + odd * x;
}
