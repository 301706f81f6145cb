// SPDX-License-Identifier: BSD-3-Clause
#include "parallel/communicator.hpp"

#include <omp.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <thread>

#include "parallel/node.hpp"
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

std::string notice_of_threads;

int cores_of_machine() {
  return static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN));
}

/// Ranks of one machine share its cores, unless the launcher has bound each to cores of its own.
void share_cores() {
  omp_set_num_threads(
      std::clamp(cores_of_machine() / ranks_of_node(Communicator::world()), 1, omp_get_num_procs()));
}

/// The first number of OMP_NUM_THREADS, which may be a list by levels of nesting; 0 where it is no count.
long threads_asked(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t+");
  if (first == std::string::npos || text[first] < '0' || text[first] > '9') return 0;
  char* end = nullptr;
  const long count = std::strtol(text.c_str() + first, &end, 10);
  while (*end == ' ' || *end == '\t') ++end;
  return *end == '\0' || *end == ',' ? count : 0;
}

/// Takes as many threads as OMP_NUM_THREADS asks for, within reason: OpenMP's own library ends the program
/// where the system does not give it a thread.
void choose_threads() {
  const char* text = std::getenv("OMP_NUM_THREADS");
  if (text == nullptr) return share_cores();
  const long asked = threads_asked(text);
  const long most = std::max(64, 4 * cores_of_machine());
  if (asked < 1) {
    share_cores();
  } else {
    omp_set_num_threads(static_cast<int>(std::min(asked, most)));
  }
  if (asked < 1 || asked > most)
    notice_of_threads = "OMP_NUM_THREADS = \"" + std::string(text).substr(0, 40) + "\" is " +
                        (asked < 1 ? "no number of threads" : "more threads than serve on this machine") +
                        "; " + std::to_string(thread_count()) + " are taken";
}

}  // namespace

MpiLibrary::MpiLibrary(int& argc, char**& argv) {
  int is_initialised = 0;
  MPI_Initialized(&is_initialised);
  if (is_initialised != 0) return;
  // Otherwise Open MPI 5 reports "Unable to find reachable pairing" on a host with IPv4 and IPv6 addresses
  // (open-mpi/ompi issue 14079), though the ranks reach each other. A setting of the user's stays.
  setenv("OMPI_MCA_reachable", "weighted", 0);
  // Open MPI opens a file with help of its components for shared file pointers, which nobody here uses:
  // 'lockedfile' makes a file beside each one that is opened, and overruns a buffer where paths have more
  // than 243 characters; 'sm' fails where /dev/shm cannot be written.
  setenv("OMPI_MCA_sharedfp", access("/dev/shm", W_OK) == 0 ? "^lockedfile" : "^lockedfile,sm",
         /*overwrite=*/0);
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  is_owner_ = true;
}

MpiLibrary::~MpiLibrary() {
  if (is_owner_) MPI_Finalize();
}

ThreadCount::ThreadCount() : before_(thread_count()) {
  notice_of_threads.clear();
  choose_threads();
}

ThreadCount::~ThreadCount() {
  omp_set_num_threads(before_);
}

Communicator Communicator::world() {
  return Communicator(MPI_COMM_WORLD);
}

Communicator Communicator::self() {
  return Communicator(MPI_COMM_SELF);
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

bool Communicator::barrier_within(double seconds) const {
  MPI_Request arrival = MPI_REQUEST_NULL;
  MPI_Ibarrier(handle_, &arrival);
  if (std::isinf(seconds)) return MPI_Wait(&arrival, MPI_STATUS_IGNORE) == MPI_SUCCESS;
  const double start = MPI_Wtime();
  int arrived = 0;
  while (MPI_Test(&arrival, &arrived, MPI_STATUS_IGNORE) == MPI_SUCCESS && arrived == 0) {
    if (MPI_Wtime() - start > seconds) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

OwnCommunicator::OwnCommunicator(Communicator original) {
  MPI_Comm_dup(original.handle(), &handle_);
}

OwnCommunicator::~OwnCommunicator() {
  MPI_Comm_free(&handle_);
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

void Communicator::broadcast_bytes(void* bytes, std::size_t count, int root) const {
  MPI_Bcast(bytes, static_cast<int>(count), MPI_BYTE, root, handle_);
}

std::string Communicator::first_non_empty(const std::string& text) const {
  const std::int64_t first = all_reduce(std::int64_t{text.empty() ? size() : rank()}, Reduce::min);
  return first == size() ? std::string{} : broadcast(text, static_cast<int>(first));
}

int ranks_of_node(const Communicator& comm) {
  MPI_Comm node;
  MPI_Comm_split_type(comm.handle(), MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &node);
  const int ranks = Communicator(node).size();
  MPI_Comm_free(&node);
  return ranks;
}

int thread_count() {
  return std::min(omp_get_max_threads(), omp_get_thread_limit());
}

const std::string& threads_notice() {
  return notice_of_threads;
}

int thread_number() {
  return omp_get_thread_num();
}

}  // namespace rhexis::parallel
