#include "parallel/communicator.hpp"

#include <omp.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include "parallel/threads.hpp"

namespace rhexis::parallel {
namespace {

MPI_Op mpi_operation(Reduce operation) {
  switch (operation) {
    case Reduce::sum:
      return MPI_SUM;
    case Reduce::min:
      return MPI_MIN;
    case Reduce::max:
      return MPI_MAX;
    case Reduce::bit_or:
      return MPI_BOR;
  }
  return MPI_OP_NULL;
}

template <class T>
void reduce_in_place(MPI_Comm comm, std::span<T> values, MPI_Datatype type, Reduce operation) {
  MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), type, mpi_operation(operation),
                comm);
}

/// Ranks of one machine share its cores, unless the launcher has bound each to cores of its own.
void share_cores() {
  MPI_Comm node;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &node);
  const int ranks = Communicator(node).size();
  MPI_Comm_free(&node);
  const auto cores_of_machine = static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN));
  omp_set_num_threads(std::clamp(cores_of_machine / ranks, 1, omp_get_num_procs()));
}

}  // namespace

Session::Session(int& argc, char**& argv) {
  // Otherwise Open MPI 5 reports "Unable to find reachable pairing" on a host with IPv4 and IPv6 addresses
  // (open-mpi/ompi issue 14079), though the ranks reach each other. A setting of the user's stays.
  setenv("OMPI_MCA_reachable", "weighted", 0);
  // Open MPI's component 'lockedfile', for shared file pointers that nobody here uses, makes a file beside
  // each one that is opened, and overruns a buffer where paths have more than 243 characters.
  setenv("OMPI_MCA_sharedfp", "^lockedfile", /*overwrite=*/0);
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  if (std::getenv("OMP_NUM_THREADS") == nullptr) share_cores();
}

Session::~Session() {
  MPI_Finalize();
}

int Communicator::rank() const {
  int rank = 0;
  MPI_Comm_rank(handle_, &rank);
  return rank;
}

int Communicator::size() const {
  int size = 1;
  MPI_Comm_size(handle_, &size);
  return size;
}

void Communicator::barrier() const {
  MPI_Barrier(handle_);
}

bool Communicator::leads_node() const {
  MPI_Comm node;
  MPI_Comm_split_type(handle_, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &node);
  const bool leads = Communicator(node).is_root();
  MPI_Comm_free(&node);
  return leads;
}

int Communicator::node_count() const {
  return static_cast<int>(all_reduce(std::int64_t{leads_node()}, Reduce::sum));
}

void Communicator::abort(int status) const {
  MPI_Abort(handle_, status);
  std::abort();
}

void Communicator::all_reduce(std::span<double> values, Reduce operation) const {
  reduce_in_place(handle_, values, MPI_DOUBLE, operation);
}

void Communicator::all_reduce(std::span<std::int64_t> values, Reduce operation) const {
  reduce_in_place(handle_, values, MPI_INT64_T, operation);
}

void Communicator::all_reduce(std::span<std::uint64_t> values, Reduce operation) const {
  reduce_in_place(handle_, values, MPI_UINT64_T, operation);
}

double Communicator::all_reduce(double value, Reduce operation) const {
  all_reduce(std::span<double>(&value, 1), operation);
  return value;
}

std::int64_t Communicator::all_reduce(std::int64_t value, Reduce operation) const {
  all_reduce(std::span<std::int64_t>(&value, 1), operation);
  return value;
}

std::string Communicator::broadcast(std::string text, int root) const {
  std::int64_t length = static_cast<std::int64_t>(text.size());
  MPI_Bcast(&length, 1, MPI_INT64_T, root, handle_);
  text.resize(static_cast<std::size_t>(length));
  MPI_Bcast(text.data(), static_cast<int>(length), MPI_CHAR, root, handle_);
  return text;
}

std::string Communicator::first_non_empty(const std::string& text) const {
  const std::int64_t first = all_reduce(std::int64_t{text.empty() ? size() : rank()}, Reduce::min);
  return first == size() ? std::string{} : broadcast(text, static_cast<int>(first));
}

int thread_count() {
  return omp_get_max_threads();
}

int thread_number() {
  return omp_get_thread_num();
}

}  // namespace rhexis::parallel
