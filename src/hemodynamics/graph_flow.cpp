#include "hemodynamics/graph_flow.hpp"

namespace rhexis::hemodynamics {

std::string_view name_of(GraphSolver solver) {
  switch (solver) {
    case GraphSolver::automatic:
      return "auto";
    case GraphSolver::elimination:
      return "elimination";
    case GraphSolver::ldlt:
      return "ldlt";
    case GraphSolver::approximate_cholesky:
      return "approximate_cholesky";
    case GraphSolver::jacobi:
      return "jacobi";
    case GraphSolver::amg:
      return "amg";
  }
  return "";
}

}  // namespace rhexis::hemodynamics
