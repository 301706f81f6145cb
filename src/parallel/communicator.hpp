// SPDX-License-Identifier: BSD-3-Clause
/// MPI behind a few words. Only `parallel/` includes <mpi.h>; a serial run is one rank of the same path.
#pragma once

#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>

namespace rhexis::parallel {

/// MPI for the life of this object (MPI_THREAD_FUNNELED: only the main thread calls MPI). Where the process
/// has initialised MPI before, it is used as it is and left running.
class MpiLibrary {
 public:
  MpiLibrary(int& argc, char**& argv);
  ~MpiLibrary();
  MpiLibrary(const MpiLibrary&) = delete;
  MpiLibrary& operator=(const MpiLibrary&) = delete;

 private:
  bool is_owner_ = false;
};

/// The number of OpenMP's threads for the life of this object: that of OMP_NUM_THREADS or, where it is not
/// set, the cores of a machine shared among its ranks. Then the caller's number returns. Collective.
class ThreadCount {
 public:
  ThreadCount();
  ~ThreadCount();
  ThreadCount(const ThreadCount&) = delete;
  ThreadCount& operator=(const ThreadCount&) = delete;

 private:
  int before_;
};

/// Both, for the life of a program.
class Session {
 public:
  Session(int& argc, char**& argv) : mpi_(argc, argv) {}

 private:
  MpiLibrary mpi_;
  ThreadCount threads_;
};

enum class Reduce { sum, min, max, bit_or };

/// A borrowed group of ranks; cheap to copy.
class Communicator {
 public:
  static Communicator world();
  /// This rank alone.
  static Communicator self();
  explicit Communicator(MPI_Comm handle) : handle_(handle) {}

  int rank() const;
  int size() const;
  bool is_root() const { return rank() == 0; }
  void barrier() const;
  /// Waits for all ranks, at most for `seconds`, which may be infinite and may differ between ranks; false
  /// where a rank has not come by then. Meets only itself, not `barrier`. Collective.
  bool barrier_within(double seconds) const;
  /// Machines that the ranks run on. Collective.
  int node_count() const;
  /// One rank of each node does.
  bool leads_node() const;
  /// Ends the program on all ranks at once with `status`: for a failure that the others cannot learn of.
  [[noreturn]] void abort(int status) const;
  MPI_Comm handle() const { return handle_; }

  /// Element-wise over all ranks, in place, result on every rank. All but the sum of doubles are exact and so
  /// do not depend on the number of ranks; for sums of doubles see ExactSum.
  void all_reduce(std::span<double> values, Reduce operation) const;
  void all_reduce(std::span<std::int64_t> values, Reduce operation) const;
  void all_reduce(std::span<std::uint64_t> values, Reduce operation) const;
  double all_reduce(double value, Reduce operation) const;
  std::int64_t all_reduce(std::int64_t value, Reduce operation) const;

  /// `text` of `root` on every rank.
  std::string broadcast(std::string text, int root = 0) const;
  /// The same of a value that may be copied byte by byte.
  template <class T>
  requires(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T> && !std::is_array_v<T>) T
      broadcast(T value, int root = 0)
  const {
    broadcast_bytes(&value, sizeof value, root);
    return value;
  }

  /// The first non-empty text in rank order, on every rank; empty if all are: how a failure on any rank
  /// becomes one message and one exit status everywhere.
  std::string first_non_empty(const std::string& text) const;

 private:
  void broadcast_bytes(void* bytes, std::size_t count, int root) const;

  MPI_Comm handle_;
};

/// The same ranks with messages of their own, for a library that sends some: a duplicate that this owns.
class OwnCommunicator {
 public:
  explicit OwnCommunicator(Communicator original);
  ~OwnCommunicator();
  OwnCommunicator(const OwnCommunicator&) = delete;
  OwnCommunicator& operator=(const OwnCommunicator&) = delete;
  MPI_Comm& handle() { return handle_; }

 private:
  MPI_Comm handle_;
};

/// Threads that OpenMP will use in a parallel region.
int thread_count();

}  // namespace rhexis::parallel
