// Lists that the page carries as base64 of little endian bytes.

function bytes(text) {
  return Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
}

export const floats = (text) => new Float32Array(bytes(text).buffer);
export const indices = (text) => new Uint32Array(bytes(text).buffer);
export { bytes };
