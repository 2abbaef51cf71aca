// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_context.hpp>
#include <polhode/simulation/probe_columns.hpp>

namespace polhode::io {

namespace {

const std::vector<std::string> kReporting = {"body", "joint", "load",    "solid",
                                             "beam", "cable", "contact", "momentum"};

}  // namespace

std::optional<ReadChannel> read_channel(ReadContext& context, Section& section) {
  ReadChannel channel;
  ProbeSpec& of = channel.spec.of;
  if (!read_recorded(context, section, kReporting, "that reports", of)) return std::nullopt;
  if (of.kind == "load" &&
      !context.model.loads[static_cast<std::size_t>(context.loads.at(of.target))].reports()) {
    section.fault("load", format("{} acts on a solid and reports nothing", quote(of.target)),
                  "Name a load on bodies.");
    return std::nullopt;
  }
  const auto name = section.text("channel");
  if (!name) return std::nullopt;
  channel.spec.name = *name;
  const std::string where = section.path("channel");
  try {
    const std::string unit = find_channel(context.model, channel.spec, where).unit;
    channel.dimension = read_unit(unit).unit.value_or(Unit{}).dimension;
  } catch (const InputError& e) {
    if (e.where() != where) return std::nullopt;  // of the joint, which is reported there
    section.fault("channel", e.what_is_wrong(), e.hint() + ".");
    return std::nullopt;
  }
  return channel;
}

}  // namespace polhode::io
