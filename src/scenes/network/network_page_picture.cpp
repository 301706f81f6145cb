// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/network/network_page_picture.hpp"

#include <stdexcept>

#include "core/error.hpp"
#include "core/installation.hpp"
#include "hemodynamics/steady/graph/network_graph.hpp"
#include "insitu/pipeline.hpp"
#include "network/connectivity.hpp"
#include "network/files/network_writer.hpp"
#include "output/temporary_file.hpp"
#include "parallel/together.hpp"

namespace rhexis::scenes {
namespace {

namespace fs = std::filesystem;

/// A picture can tell no more apart, and each takes memory of the renderer.
constexpr std::size_t most_drawn = 200000;

/// The vessels as lines with `radius` (m); points with `end` (0: none, 1: with a condition, 2: without).
class DrawnNetwork final : public LineSource {
 public:
  explicit DrawnNetwork(const network::BoundedGraph& network)
      : vessels_(network.graph.vessels()),
        graph_(network::with_vessels_for_pieces(network).graph),
        end_(graph_.junctions) {
    const std::vector<std::uint32_t> degree = network::degrees(graph_);
    for (std::size_t j = 0; j < end_.size(); ++j) end_[j] = degree[j] == 1 ? 2 : 0;
    for (const network::BoundaryCondition& condition : network.conditions) end_[condition.junction] = 1;
    for (const std::uint32_t v : hemodynamics::widest_vessels(graph_, most_drawn)) {
      ends_.push_back(graph_.from[v]);
      ends_.push_back(graph_.to[v]);
      radius_.push_back(graph_.radius[v]);
    }
  }

  long step() const override { return 0; }
  double time_s() const override { return 0; }
  FieldView positions() override {
    return {{"position", "m", 3, Centring::point},
            {graph_.x.data(), graph_.y.data(), graph_.z.data()},
            graph_.junctions};
  }
  std::span<const std::int64_t> connectivity() override { return ends_; }
  std::span<const FieldInfo> fields() const override { return infos; }
  FieldView field(std::string_view name) override {
    if (name == infos[0].name) return {infos[0], {radius_.data()}, radius_.size()};
    if (name == infos[1].name) return {infos[1], {end_.data()}, end_.size()};
    throw std::out_of_range("a drawn network has no field " + std::string(name));
  }
  std::vector<Annotation> annotations() const override {
    const bool is_whole = radius_.size() == graph_.vessels();
    return {{"shown", "1", static_cast<double>(is_whole ? vessels_ : radius_.size())},
            {"vessels", "1", static_cast<double>(vessels_)}};
  }

  static constexpr FieldInfo infos[] = {{"radius", "m", 1, Centring::cell}, {"end", "1", 1, Centring::point}};

 private:
  const std::size_t vessels_;       // of the network
  const network::Graph graph_;      // with their pieces as vessels
  std::vector<double> end_;         // [J]
  std::vector<std::int64_t> ends_;  // two junctions a vessel
  std::vector<double> radius_;      // of the vessels drawn
};

/// A folder that goes with its owner.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(fs::path path) : path_(std::move(path)) {}
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

insitu::Settings settings() {
  insitu::ChannelFields channel{"network", {}};
  for (const FieldInfo& info : DrawnNetwork::infos) channel.fields.emplace_back(info.name);
  insitu::Settings settings;
  settings.scripts = {(own_catalyst_scripts() / "network_page.py").string()};
  settings.channels = {channel};
  return settings;
}

}  // namespace

void check_picture_can_be_drawn(parallel::Communicator comm) {
  const std::string obstacle = insitu::inspect_scripts(settings(), comm);
  if (!obstacle.empty()) throw InputError("--picture: there can be no picture: " + obstacle);
}

void draw_network_page(const network::BoundedGraph& network, const fs::path& path,
                       parallel::Communicator comm) {
  const TemporaryFolder folder(comm.broadcast(output::temporary_name_beside(fs::absolute(path)).string()));
  insitu::Settings drawing = settings();
  drawing.image_directory = folder.path().string();
  DrawnNetwork drawn(network);
  const auto pipeline = insitu::load_pipeline(drawing, comm);
  pipeline->process(0, 0, {{"network", &drawn}});
  pipeline->finish();
  parallel::on_root<RunError>(comm, [&] {
    std::error_code error;
    fs::rename(folder.path() / "network_page.png", path, error);
    if (error) throw RunError(path.string() + ": cannot be written: " + error.message());
  });
}

}  // namespace rhexis::scenes
