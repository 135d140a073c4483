
/* The k-th derivative of G(n) = a / sin a, n = sin(a/2)^2, for 0 <= n < 1, by its series where that is short. */
FUNCTION double $log_ratio(int k, POINTER series, double n) {
    if (n <= 0.015) return $polynomial(series, 9, n);
    if (n <= 0.12) return $polynomial(series, 20, n);
    if (n <= 0.25) return $polynomial(series, 34, n);
    const double slope = 1.0 - 2.0 * n, twice = 2.0 * n * (1.0 - n);
    double lower = asin(sqrt(n)) / sqrt(n * (1.0 - n)), value;
    if (k == 0) return lower;
    value = (1.0 - slope * lower) / twice;
    for (int i = 1; i < k; i++) {
        const double next = (2.0 * i * i * lower - (2.0 * i + 1.0) * slope * value) / twice;
        lower = value;
        value = next;
    }
    return value;
}
