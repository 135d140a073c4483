// A polynomial by Horner's rule in the fourth power of its argument: the order of operations of the library.
function chain(coefficients, count, first, fourth) {
  let at = first + Math.floor((count - 1 - first) / 4) * 4, sum = coefficients[at];
  while ((at -= 4) >= first) sum = sum * fourth + coefficients[at];
  return sum;
}
function polynomial(coefficients, count, x) {
  const square = x * x, fourth = square * square;
  const even = chain(coefficients, count, 0, fourth) + chain(coefficients, count, 2, fourth) * square;
  const odd = chain(coefficients, count, 1, fourth) + chain(coefficients, count, 3, fourth) * square;
  return even + odd * x;
}
// The Stumpff function c_k(q), the sum of (-q)^i / (2i + k)! for q >= 0, by its series where that is short.
function stumpff(k, series, q) {
  if (q <= 0.5) return polynomial(series, 9, q);
  if (q <= 12) return polynomial(series, 34, q);
  const root = Math.sqrt(q), lower = [Math.cos(root), Math.sin(root) / root];
  let reciprocal = 1;
  for (let i = 0; i < k - 1; i++) {
    if (i > 0) reciprocal /= i;
    lower[i % 2] = (reciprocal - lower[i % 2]) / q;
  }
  return lower[k % 2];
}
// The k-th derivative of G(n) = a / sin a, n = sin(a/2)^2, for 0 <= n < 1, by its series where that is short.
function log_ratio(k, series, n) {
  if (n <= 0.015) return polynomial(series, 9, n);
  if (n <= 0.12) return polynomial(series, 20, n);
  if (n <= 0.25) return polynomial(series, 34, n);
  const slope = 1 - 2 * n, twice = 2 * n * (1 - n);
  let lower = Math.asin(Math.sqrt(n)) / Math.sqrt(n * (1 - n));
  if (k === 0) return lower;
  let value = (1 - slope * lower) / twice;
  for (let i = 1; i < k; i++) {
    const next = (2 * i * i * lower - (2 * i + 1) * slope * value) / twice;
    lower = value;
    value = next;
  }
  return value;
}
