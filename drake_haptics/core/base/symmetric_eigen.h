#pragma once

#include "base/types.h"

namespace drake_haptics {

/// Eigenvalues, smallest first, and the eigenvectors as columns in the same
/// order.
struct SymmetricEigen {
  Vec6 values;
  Mat6 vectors;
};

/// Returns the eigenvalues and eigenvectors of a symmetric matrix, of which it
/// reads the lower half. Not inline: Eigen's solver takes the compiler as long
/// as several whole files do.
SymmetricEigen DecomposeSymmetric(const Mat6& matrix);

}  // namespace drake_haptics
