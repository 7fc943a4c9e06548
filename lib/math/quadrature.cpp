#include "math/quadrature.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "math/elementary.h"

namespace goniochrome::math {

// The points are the roots of the Legendre polynomial P_n, by Newton's method from Tricomi's approximation; with
// P_n' at a root the weight is 2 / ((1 - x^2) P_n'(x)^2). P_n comes from its three-term recurrence.
std::vector<QuadraturePoint> gauss_legendre(int n) {
  std::vector<QuadraturePoint> points(static_cast<std::size_t>(std::max(n, 0)));
  for (int k = 0; k < n; ++k) {
    double x = -math::cos(kPi * (k + 0.75) / (n + 0.5)), slope = 1;
    if (2 * k + 1 == n) x = 0;
    for (int step = 0; step < 20; ++step) {
      double p = 1, before = 0;
      for (int i = 0; i < n; ++i) {
        const double next = ((2 * i + 1) * x * p - i * before) / (i + 1);
        before = p, p = next;
      }
      slope = n * (before - x * p) / (1 - x * x);
      const double change = p / slope;
      x -= change;
      if (std::abs(change) <= 1e-16) break;
    }
    points[k] = {x, 2 / ((1 - x * x) * slope * slope)};
  }
  return points;
}

// Polynomials that are orthogonal over the points obey a recurrence of three terms, whose coefficients Lanczos' method
// finds. They make a tridiagonal matrix: its eigenvalues are the positions, and the first parts of its eigenvectors
// tell the weights. [Golub and Welsch, Calculation of Gauss quadrature rules, 1969]
std::vector<QuadraturePoint> fewer_points(std::vector<QuadraturePoint> points, int count) {
  const auto from = static_cast<Eigen::Index>(points.size());
  if (count >= from) return points;
  Eigen::VectorXd positions(from), next(from);
  for (Eigen::Index i = 0; i < from; ++i) {
    const QuadraturePoint& point = points[static_cast<std::size_t>(i)];
    positions[i] = point.position, next[i] = std::sqrt(point.weight);
  }
  const double total = next.squaredNorm();
  Eigen::MatrixXd polynomials(from, count);
  Eigen::VectorXd diagonal(count), beside(count);
  for (int k = 0; k < count; ++k) {
    polynomials.col(k) = next.normalized();
    next = positions.cwiseProduct(polynomials.col(k));
    diagonal[k] = next.dot(polynomials.col(k));
    const auto found = polynomials.leftCols(k + 1);
    for (int pass = 0; pass < 2; ++pass) next -= found * (found.transpose() * next).eval();
    beside[k] = next.norm();
  }
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> matrix;
  matrix.computeFromTridiagonal(diagonal, beside.head(count - 1));
  points.clear();
  for (int k = 0; k < count; ++k) {
    const double part = matrix.eigenvectors()(0, k);
    points.push_back({matrix.eigenvalues()[k], total * part * part});
  }
  return points;
}

GaussRule gauss_rule(int points, int pieces) {
  const GaussPoints& piece_rule = kGaussPoints[static_cast<std::size_t>(points) - 1];
  GaussRule rule;
  for (int piece = 0; piece < pieces; ++piece)
    for (int i = 0; i < points; ++i) {
      rule.at.push_back((piece + piece_rule.at[i]) / pieces);
      rule.weight.push_back(piece_rule.weight[i] / pieces);
    }
  return rule;
}

}  // namespace goniochrome::math
