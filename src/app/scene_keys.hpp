// SPDX-License-Identifier: BSD-3-Clause
/// Which keys there are: those of every kind of scene, and those of the one that a document describes.
#pragma once

#include <optional>
#include <string>

#include "app/configuration.hpp"
#include "coupling/parameters.hpp"
#include "input/document.hpp"
#include "studies/ensemble/parameters.hpp"

namespace rhexis::app {

/// Every key there is, with homes for their values, of which only the defaults are used.
class AllKeys {
 public:
  AllKeys();
  AllKeys(const AllKeys&) = delete;
  AllKeys& operator=(const AllKeys&) = delete;

  const ParameterList& list() const { return list_; }

 private:
  std::string model_;
  scenes::VesselScene vessel_;
  scenes::NetworkInput network_;
  coupling::Parameters coupling_;
  ensemble::Parameters ensemble_;
  ParameterList list_;
};

/// A scene of the kind that the document's scene.model names, into which nothing has been read; none where
/// there is no such kind.
std::optional<Configuration> scene_named(const input::Document& document);

/// The keys of the scene's kind, bound to it and, scene.model, to `model`.
ParameterList declare(Configuration& scene, std::string& model);

/// Throws InputError for a section or a key of the document that `keys`, those of the kind `model`, are
/// without, where another kind of scene has it.
void refuse_keys_of_other_kinds(const input::Document& document, const ParameterList& keys,
                                const std::string& model);

}  // namespace rhexis::app
