#include "tests/engine/terms/check_term.h"

#include <Eigen/Eigenvalues>

namespace toile::test {

Eigen::VectorXd eigenvalues_of(const Eigen::MatrixXd& symmetric) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric, Eigen::EigenvaluesOnly).eigenvalues();
}

}  // namespace toile::test
