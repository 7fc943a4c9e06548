// Random small fitting problems of every kind that breaks solvers, for the tests of this module alone.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "base/angles.h"
#include "math/least_squares.h"

namespace goniochrome::math::problems {

// How many problems to try: `usual`, or as many as the environment variable GONIOCHROME_TRIALS asks for.
inline int trials(int usual) {
  const char* asked = std::getenv("GONIOCHROME_TRIALS");
  return asked ? std::max(1, std::atoi(asked)) : usual;
}

struct Problem {
  std::string kind;
  Matrix m{0, 0};
  std::vector<double> b;
};

inline const std::vector<std::string>& kinds() {
  static const std::vector<std::string> all = {"lobes",          "dense",         "collinear",  "tied",
                                               "zero-target",    "zero-columns",  "one-sample", "scaled-target",
                                               "scaled-columns", "weighted-rows", "exact",      "signed"};
  return all;
}

// Columns cos^E at angles 0..110 deg and the constant, exponents log-uniform in 1..3000; b a rising flank plus noise.
inline Problem lobes(std::mt19937_64& random, int rows, int columns) {
  std::uniform_real_distribution<double> unit(0, 1);
  Problem p;
  p.m = Matrix(rows, columns);
  p.b.resize(rows);
  std::vector<double> exponents = {0};
  for (int j = 1; j < columns; ++j) exponents.push_back(std::pow(3000.0, unit(random)));
  const double rate = 30 * unit(random), noise = 0.2 * unit(random);
  for (int i = 0; i < rows; ++i) {
    const double angle = (i == 0 ? 15 : 15 + 95 * unit(random)) * kDegree;
    const double c = std::max(std::cos(angle), 0.0);
    for (int j = 0; j < columns; ++j) p.m(i, j) = std::pow(c, exponents[j]);
    p.b[i] = 0.1 + std::pow(c, rate) * 2 + noise * (unit(random) - 0.5);
  }
  return p;
}

inline Problem make(const std::string& kind, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  std::uniform_int_distribution<int> few(0, 2);
  const int columns = 1 + static_cast<int>(random() % 9), rows = 1 + static_cast<int>(random() % 12);
  Problem p = lobes(random, rows, columns);
  p.kind = kind;
  if (kind == "dense" || kind == "signed" || kind == "exact") {
    for (double& v : p.m.values) v = kind == "signed" ? 2 * unit(random) - 1 : unit(random);
    for (double& v : p.b) v = 2 * unit(random) - 0.5;
    if (kind == "exact") {
      std::fill(p.b.begin(), p.b.end(), 0.0);
      for (int j = 0; j < columns; ++j) {
        const double x = few(random) * unit(random);
        for (int i = 0; i < rows; ++i) p.b[i] += x * p.m(i, j);
      }
    }
  } else if (kind == "collinear") {
    for (int j = 1; j < columns; j += 2)
      for (int i = 0; i < rows; ++i)
        p.m(i, j) = p.m(i, j - 1) * (few(random) ? 1 : 1 + 1e-13 * unit(random)) * (j % 4 == 1 ? 1 : 3);
  } else if (kind == "tied") {
    for (double& v : p.m.values) v = few(random);
    for (double& v : p.b) v = few(random);
  } else if (kind == "zero-target") {
    for (double& v : p.b) v = few(random) ? 0 : -0.0;
  } else if (kind == "zero-columns") {
    for (int j = 0; j < columns; j += 2)
      for (int i = 0; i < rows; ++i) p.m(i, j) = 0;
  } else if (kind == "one-sample") {
    Problem one = lobes(random, 1, columns);
    p.m = one.m, p.b = one.b;
  } else if (kind == "scaled-target") {
    const double s = std::pow(10, 24 * unit(random) - 12);
    for (double& v : p.b) v *= s;
  } else if (kind == "scaled-columns") {
    for (int j = 0; j < columns; ++j) {
      const double s = std::pow(10, 24 * unit(random) - 12);
      for (int i = 0; i < rows; ++i) p.m(i, j) *= s;
    }
  } else if (kind == "weighted-rows") {
    for (int i = 0; i < rows; ++i) {
      const double s = std::pow(10, 6 * unit(random) - 3);
      for (int j = 0; j < columns; ++j) p.m(i, j) *= s;
      p.b[i] *= s;
    }
  }
  return p;
}

}  // namespace goniochrome::math::problems
