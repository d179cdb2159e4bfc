import {
  DoubleSide,
  FrontSide,
  MeshBasicMaterial,
  type Material,
  type MeshPhysicalMaterial,
  type MeshStandardMaterial,
  type Texture,
} from 'three';

/** The light map says all there is to see of a surface, but for its holes and what is seen through it. */
export class Surfaces {
  #map: Texture | undefined;
  readonly #all: MeshBasicMaterial[] = [];
  readonly #plain = {
    oneSided: this.#make(new MeshBasicMaterial()),
    twoSided: this.#make(new MeshBasicMaterial({ side: DoubleSide })),
  };
  readonly #uneven = new Map<Material, MeshBasicMaterial>();

  /** What stands for a material of the file. */
  like(original: Material): MeshBasicMaterial {
    const { transmission = 0 } = original as Partial<MeshPhysicalMaterial>;
    const isEven = original.alphaTest === 0 && !original.transparent && transmission === 0;
    if (isEven) return original.side === DoubleSide ? this.#plain.twoSided : this.#plain.oneSided;
    const known = this.#uneven.get(original);
    if (known) return known;
    const made = this.#make(
      new MeshBasicMaterial({
        side: original.side === DoubleSide ? DoubleSide : FrontSide,
        alphaTest: original.alphaTest,
        opacity: original.opacity * (1 - transmission),
        transparent: original.transparent || transmission > 0,
        depthWrite: original.alphaTest > 0,
      }),
    );
    const texture = transmission > 0 ? null : (original as MeshStandardMaterial).map;
    if (texture) {
      made.alphaMap = texture;
      // three.js reads an alpha map's green.
      made.onBeforeCompile = (shader) => {
        shader.fragmentShader = shader.fragmentShader.replace(
          '#include <alphamap_fragment>',
          'diffuseColor.a *= texture2D( alphaMap, vAlphaMapUv ).a;',
        );
      };
    }
    this.#uneven.set(original, made);
    return made;
  }

  /** Nothing is drawn before the first map: without light there is nothing to see. */
  show(map: Texture): void {
    if (this.#map === map) return;
    this.#map = map;
    for (const material of this.#all) this.#light(material);
  }

  #make(material: MeshBasicMaterial): MeshBasicMaterial {
    material.visible = false;
    this.#all.push(material);
    this.#light(material);
    return material;
  }

  #light(material: MeshBasicMaterial): void {
    if (!this.#map) return;
    material.visible = true;
    material.map = this.#map;
    material.needsUpdate = true;
  }
}
