import { EdgesGeometry, Mesh, type Object3D } from 'three';
import { LineMaterial } from 'three/addons/lines/LineMaterial.js';
import { LineSegments2 } from 'three/addons/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/addons/lines/LineSegmentsGeometry.js';

/** Draws the edges of everything below `node`, 3 pixels wide. */
export function outline(node: Object3D, colour: string) {
  const material = new LineMaterial({ color: colour, linewidth: 3 });
  const lines: LineSegments2[] = [];
  const meshes: Mesh[] = [];
  node.traverse((object) => {
    if (object instanceof Mesh && !(object instanceof LineSegments2)) meshes.push(object);
  });
  for (const mesh of meshes) {
    const edges = new EdgesGeometry(mesh.geometry);
    const line = new LineSegments2(new LineSegmentsGeometry().fromEdgesGeometry(edges), material);
    edges.dispose();
    line.scale.setScalar(1.01); // clear of the faces, which would cut the line in half
    mesh.add(line);
    lines.push(line);
  }
  return {
    /** The line width is in pixels, so the material has to know how many there are. */
    resize: (width: number, height: number) => material.resolution.set(width, height),
    remove() {
      for (const line of lines) {
        line.removeFromParent();
        line.geometry.dispose();
      }
      material.dispose();
    },
  };
}
