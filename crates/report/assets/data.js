"use strict";
// Columns of the page: 32-bit floats in base64, missing values as null.
const gyrocalData = (() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const decoded = new Map();
  const column = (number) => {
    if (!decoded.has(number)) {
      const bytes = Uint8Array.from(atob(data.columns[number]), (letter) => letter.charCodeAt(0));
      const values = Array.from(new Float32Array(bytes.buffer));
      decoded.set(number, values.map((value) => (Number.isNaN(value) ? null : value)));
    }
    return decoded.get(number);
  };
  return { charts: data.charts, column };
})();
