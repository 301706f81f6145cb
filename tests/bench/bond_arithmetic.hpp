// SPDX-License-Identifier: BSD-3-Clause
// What this machine can do at most of the arithmetic that a bond takes.
#pragma once

namespace rhexis::bench {

/// Bonds/s of the PMB law, both ends, whose operands stay in registers or the nearest cache and which wait
/// for no other: what the processor's arithmetic units can issue, whatever their number and kinds. Bonds in
/// `Real`.
template <class Real>
double bond_arithmetic_rate(int threads);

}  // namespace rhexis::bench
