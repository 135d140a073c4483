
/* The Stumpff function c_k(q) = sum of (-q)^i / (2i + k)! for q >= 0, by its series where that is short. */
FUNCTION double $stumpff(int k, POINTER series, double q) {
    if (q <= 0.5) return $polynomial(series, 9, q);
    if (q <= 12.0) return $polynomial(series, 34, q);
    const double root = sqrt(q);
    double lower[2] = {cos(root), sin(root) / root}, reciprocal = 1.0;
    for (int i = 0; i < k - 1; i++) {
        if (i > 0) reciprocal /= i;
        lower[i % 2] = (reciprocal - lower[i % 2]) / q;
    }
    return lower[k % 2];
}
