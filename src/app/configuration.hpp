// SPDX-License-Identifier: BSD-3-Clause
/// The reading of an input file into a configuration, and the keys that input files may have.
#pragma once

#include <string>
#include <vector>

#include "core/parameter.hpp"
#include "parallel/communicator.hpp"
#include "scenes/configuration.hpp"

namespace rhexis::app {

using scenes::Configuration;

/// Every key there is, bound to `c`.
ParameterList declare(Configuration& c);

/// Reads and validates `file` with `overrides` into `c`, where `say` and `checks` may be set, and
/// resolves what follows from them: the wall and the plan of output, or the rules of a tree. Only the
/// sections of the scene's model are read; any other is an error. Collective: one rank reads, all get the
/// same configuration or the same InputError.
Configuration read_configuration(const std::string& file, const std::vector<std::string>& overrides,
                                 parallel::Communicator comm, Configuration c = {});

}  // namespace rhexis::app
