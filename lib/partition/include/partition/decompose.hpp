// From a mesh to subdomains on ranks.
#pragma once

#include "base/context.hpp"
#include "mesh/options.hpp"
#include "partition/decomposition.hpp"
#include "partition/options.hpp"

namespace mortise::partition {

/// Reads or generates the mesh and cuts every body into face-connected subdomains.
///
/// Files, and blocks cut by METIS, pass through rank 0, which sends each rank its subdomains; blocks with `method: grid` are
/// generated where they are needed. Subdomains are numbered body by body, cluster by cluster, and dealt to the ranks in
/// contiguous ranges of whole clusters with about equal numbers of cells; neither their numbers nor their cells nor the clusters
/// depend on the number of ranks. Throws Error(bad_input) on every rank for what mesh::read() rejects. Times the stages "mesh"
/// and "partition". Collective.
Decomposition decompose(const mesh::Options& mesh, const Options& options, int dimension, const Context& context);

/// The part, 0 .. parts-1, of each cell of one body: METIS k-way on the dual graph, repaired so that every part is face-connected
/// (an island joins the neighbour with which it has most faces in common), numbered in the order of their smallest cells. May
/// return fewer parts than asked for. Deterministic.
std::vector<int> cut(const mesh::Cells& cells, int parts);

/// The cluster, 0 .. n-1, of each subdomain of one body, about `size` subdomains each: METIS k-way on the graph of subdomains
/// that have cell faces in common, weighted with how many, repaired as by cut(), so that faces connect every cluster.
/// `subdomain`: of each cell, as cut() gives it. Deterministic.
std::vector<int> cluster(const mesh::Cells& cells, const std::vector<int>& subdomain, int size);

}  // namespace mortise::partition
