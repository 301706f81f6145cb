// SPDX-License-Identifier: BSD-3-Clause
/// Signals that ask a run to end: SIGINT (Ctrl-C), SIGTERM (mpirun, batch systems), SIGHUP (the terminal is
/// gone; not where it is ignored, as under nohup), and SIGUSR1 and SIGXCPU, which batch systems send some
/// time ahead of the end.
///
/// A handler only notes a signal; a thread does the rest, so that a run which is stuck (in a message to a
/// rank that died) leaves a true record too.
#pragma once

#include <filesystem>
#include <string>

#include "output/run_record.hpp"

namespace rhexis::runtime {

/// Remembers whether SIGHUP is ignored, as under nohup: runs leave it ignored then. To be called before the
/// constructors of shared libraries, one of which (UCX's, which Open MPI 5 loads) takes SIGHUP for itself.
void note_ignored_hangup();

/// Makes files beyond the limit of their size (SIGXFSZ) and closed pipes (SIGPIPE) failures of the call that
/// writes. To be called at the program's start, before MPI, which changes signals.
void prepare_signals();

/// "SIGTERM".
std::string signal_name(int signal);
/// "interrupted by SIGTERM".
std::string interrupted_by(int signal);

/// While it lives, signals are noted and told to a run's record; without one, they do what they do by
/// default. It is made before the record is written, so that no record says "running" of a run that a signal
/// ended. Where no InterruptGuard lives besides, there is nothing to save: a signal leaves its words in the
/// record and ends the program with status 128 + signal.
class SignalWatch {
 public:
  /// `folder`: where temporary files are to go when the program ends at once. `writes`: this rank is the one
  /// that tells the record, and the user. `embedded`: the run is in another program, so that a signal is
  /// noted as under an InterruptGuard, and one that the program ignores stays ignored.
  SignalWatch(const std::filesystem::path& folder, bool writes, bool embedded);
  ~SignalWatch();
  SignalWatch(const SignalWatch&) = delete;
  SignalWatch& operator=(const SignalWatch&) = delete;

  /// The record to tell; it must live on. A signal that has come already is told at once.
  void tell(output::RunRecord& record);

 private:
  output::RunRecord* record_ = nullptr;
};

/// While it lives, the first signal is left to the run to act on: the record tells of it at once, in case
/// nothing more comes of it. A second SIGINT, SIGTERM or SIGHUP changes nothing, a third ends the program at
/// once.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  /// The first signal that this rank has got since the run began; 0 where there was none.
  static int requested();
};

/// Tells the records of all runs at work that they end for this reason, which this rank alone knows: it is
/// about to end the program for all.
void fail_records_alone(const std::string& reason) noexcept;

}  // namespace rhexis::runtime
