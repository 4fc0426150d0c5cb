// gmsh's functions, looked up when a file needs them. With OpenCASCADE's its library brings 95 others, and linking them at every
// start took four fifths of the processor time of a small run.
#pragma once

#include <gmsh.h>

namespace mortise::mesh {

/// The functions of gmsh's interface that are used here, under their own names; see gmsh.h.
struct GmshLibrary {
  decltype(gmsh::initialize)* initialize = gmsh::initialize;
  decltype(gmsh::open)* open = gmsh::open;
  decltype(gmsh::option::setNumber)* setNumber = gmsh::option::setNumber;
  decltype(gmsh::option::getNumber)* getNumber = gmsh::option::getNumber;
  decltype(gmsh::logger::start)* startLogger = gmsh::logger::start;
  decltype(gmsh::logger::get)* getLog = gmsh::logger::get;
  decltype(gmsh::model::getEntities)* getEntities = gmsh::model::getEntities;
  decltype(gmsh::model::getEntityName)* getEntityName = gmsh::model::getEntityName;
  decltype(gmsh::model::getType)* getType = gmsh::model::getType;
  decltype(gmsh::model::getAdjacencies)* getAdjacencies = gmsh::model::getAdjacencies;
  decltype(gmsh::model::getBoundary)* getBoundary = gmsh::model::getBoundary;
  decltype(gmsh::model::removeEntities)* removeEntities = gmsh::model::removeEntities;
  decltype(gmsh::model::addPhysicalGroup)* addPhysicalGroup = gmsh::model::addPhysicalGroup;
  decltype(gmsh::model::setPhysicalName)* setPhysicalName = gmsh::model::setPhysicalName;
  decltype(gmsh::model::getPhysicalName)* getPhysicalName = gmsh::model::getPhysicalName;
  decltype(gmsh::model::getPhysicalGroups)* getPhysicalGroups = gmsh::model::getPhysicalGroups;
  decltype(gmsh::model::getPhysicalGroupsForEntity)* getPhysicalGroupsForEntity = gmsh::model::getPhysicalGroupsForEntity;
  decltype(gmsh::model::getEntitiesForPhysicalGroup)* getEntitiesForPhysicalGroup = gmsh::model::getEntitiesForPhysicalGroup;
  decltype(gmsh::model::getParametrizationBounds)* getParametrizationBounds = gmsh::model::getParametrizationBounds;
  decltype(gmsh::model::getValue)* getValue = gmsh::model::getValue;
  decltype(gmsh::model::getNormal)* getNormal = gmsh::model::getNormal;
  decltype(gmsh::model::getPrincipalCurvatures)* getPrincipalCurvatures = gmsh::model::getPrincipalCurvatures;
  decltype(gmsh::model::mesh::generate)* generate = gmsh::model::mesh::generate;
  decltype(gmsh::model::mesh::getNodes)* getNodes = gmsh::model::mesh::getNodes;
  decltype(gmsh::model::mesh::getElements)* getElements = gmsh::model::mesh::getElements;
  decltype(gmsh::model::mesh::getElementsByType)* getElementsByType = gmsh::model::mesh::getElementsByType;
  decltype(gmsh::model::mesh::getElementProperties)* getElementProperties = gmsh::model::mesh::getElementProperties;
};

/// The function of gmsh_functions.cpp that the program looks up.
using GetGmshLibrary = const GmshLibrary*();

/// Loads gmsh's library at the first call. Throws Error(machine) if it cannot be loaded.
const GmshLibrary& library();

}  // namespace mortise::mesh
