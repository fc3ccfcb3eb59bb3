// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/cloth_object.h"

#include <OgreCamera.h>
#include <OgreHardwareBufferManager.h>
#include <OgreSceneNode.h>

namespace curtain_rviz {
namespace {

Ogre::Vector3 toOgre(const curtain::Vec3& v) {
  return {static_cast<Ogre::Real>(v.x()), static_cast<Ogre::Real>(v.y()), static_cast<Ogre::Real>(v.z())};
}

template <typename Element>
void write(const Ogre::HardwareVertexBufferSharedPtr& buffer, const std::vector<Element>& elements) {
  buffer->writeData(0, elements.size() * sizeof(Element), elements.data(), true);
}

}  // namespace

ClothObject::ClothObject(const Ogre::MaterialPtr& material) {
  static_assert(sizeof(SurfaceVertex) == 7 * sizeof(float) && sizeof(ClothCoordinate) == 2 * sizeof(float),
                "they lie in buffers as they are");
  Ogre::VertexDeclaration* const layout = vertices_.vertexDeclaration;
  layout->addElement(kMoving, offsetof(SurfaceVertex, position), Ogre::VET_FLOAT3, Ogre::VES_POSITION);
  layout->addElement(kMoving, offsetof(SurfaceVertex, normal), Ogre::VET_FLOAT3, Ogre::VES_NORMAL);
  layout->addElement(kMoving, offsetof(SurfaceVertex, hollow), Ogre::VET_FLOAT1, Ogre::VES_TEXTURE_COORDINATES, 1);
  layout->addElement(kCoordinates, 0, Ogre::VET_FLOAT2, Ogre::VES_TEXTURE_COORDINATES, 0);
  layout->addElement(kValues, 0, Ogre::VET_FLOAT1, Ogre::VES_TEXTURE_COORDINATES, 2);
  mRenderOp.operationType = Ogre::RenderOperation::OT_TRIANGLE_LIST;
  mRenderOp.useIndexes = true;
  mRenderOp.vertexData = &vertices_;
  mRenderOp.indexData = &indices_;
  setMaterial(material);
  setVisible(false);  // until there is a cloth
}

ClothObject::~ClothObject() = default;

Ogre::HardwareVertexBufferSharedPtr ClothObject::buffer(Source source) const {
  return vertices_.vertexBufferBinding->getBuffer(source);
}

void ClothObject::setCloth(const CurtainSurface& surface) {
  Ogre::HardwareBufferManager& buffers = Ogre::HardwareBufferManager::getSingleton();
  const std::size_t count = surface.vertices().size();
  const auto bind = [&](Source source, std::size_t size, Ogre::HardwareBuffer::Usage usage) {
    vertices_.vertexBufferBinding->setBinding(source, buffers.createVertexBuffer(size, count, usage));
  };
  bind(kMoving, sizeof(SurfaceVertex), Ogre::HardwareBuffer::HBU_DYNAMIC_WRITE_ONLY_DISCARDABLE);
  bind(kCoordinates, sizeof(ClothCoordinate), Ogre::HardwareBuffer::HBU_STATIC_WRITE_ONLY);
  bind(kValues, sizeof(float), Ogre::HardwareBuffer::HBU_DYNAMIC_WRITE_ONLY_DISCARDABLE);
  vertices_.vertexStart = 0;
  vertices_.vertexCount = count;
  write(buffer(kCoordinates), surface.coordinates());
  setValues(std::vector<float>(count, 0.0F));

  const auto& triangles = surface.triangles();
  indices_.indexStart = 0;
  indices_.indexCount = 3 * triangles.size();
  indices_.indexBuffer = buffers.createIndexBuffer(Ogre::HardwareIndexBuffer::IT_32BIT, indices_.indexCount,
                                                   Ogre::HardwareBuffer::HBU_STATIC_WRITE_ONLY);
  indices_.indexBuffer->writeData(0, triangles.size() * sizeof(triangles.front()), triangles.data(), true);
}

void ClothObject::move(const CurtainSurface& surface) {
  write(buffer(kMoving), surface.vertices());
  const Ogre::Vector3 lowest = toOgre(surface.lowest()), highest = toOgre(surface.highest());
  setBoundingBox(Ogre::AxisAlignedBox(lowest, highest));
  // Ogre's: a sphere around the origin.
  radius_ = std::sqrt(std::max(lowest.squaredLength(), highest.squaredLength()) + (highest - lowest).squaredLength());
  if (getParentSceneNode() != nullptr) getParentSceneNode()->needUpdate();
}

void ClothObject::setValues(const std::vector<float>& values) { write(buffer(kValues), values); }

Ogre::Real ClothObject::getSquaredViewDepth(const Ogre::Camera* camera) const {
  return (getWorldBoundingBox(true).getCenter() - camera->getDerivedPosition()).squaredLength();
}

}  // namespace curtain_rviz
