// Files that the page makes.

export function save(blob: Blob, name: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

export const saveText = (text: string, type: string, name: string): void => save(new Blob([text], { type }), name);

/** An SVG as a PNG of twice its size. */
export async function png(svg: Blob): Promise<Blob> {
  const picture = new Image();
  const address = URL.createObjectURL(svg);
  picture.src = address;
  await picture.decode();
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [2 * picture.naturalWidth, 2 * picture.naturalHeight];
  canvas.getContext("2d")?.drawImage(picture, 0, 0, canvas.width, canvas.height);
  URL.revokeObjectURL(address);
  return new Promise((go, fail) => canvas.toBlob((blob) => (blob ? go(blob) : fail(new Error("no picture"))), "image/png"));
}
