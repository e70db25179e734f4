// Meshes to turn with the mouse: every figure.turnable holds its mesh, and is drawn by WebGL 2.
(() => {
  const VERTEX = `#version 300 es
    in vec3 place, tone, way, side; uniform mat3 turn; uniform float zoom, wide, apart;
    out vec3 color, at, rim;
    void main() {
      at = turn * (place + apart * way); color = tone; rim = side;
      gl_Position = vec4(at.x * zoom / wide, at.y * zoom, -at.z * 0.2, 1.0 - at.z * 0.22); }`;
  const FRAGMENT = `#version 300 es
    precision highp float; in vec3 color, at, rim; uniform float wires; out vec4 pixel;
    void main() {
      vec3 n = normalize(cross(dFdx(at), dFdy(at))); n *= sign(n.z);
      float light = 0.42 + 0.5 * max(dot(n, vec3(-0.45, 0.68, 0.58)), 0.0) + 0.16 * n.z;
      vec3 near = rim / fwidth(rim);
      float line = 1.0 - smoothstep(0.2, 1.0, min(near.x, min(near.y, near.z)));
      pixel = vec4(color * light * (1.0 - 0.45 * wires * line), 1.0); }`;

  async function unpacked(text, Type) {
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
    return new Type(await new Response(stream).arrayBuffer());
  }

  // Twelve numbers for each corner of each triangle: its place, color, way apart, and which it is.
  async function corners(mesh) {
    const points = await unpacked(mesh.points, Int16Array);
    const piece = await unpacked(mesh.piece, Uint16Array);
    const faces = await unpacked(mesh.triangles, Uint32Array);
    const colors = await unpacked(mesh.colors, Uint8Array);
    const ways = await unpacked(mesh.ways, Float32Array);
    const count = faces.length, data = new Float32Array(12 * count);
    for (let i = 0; i < count; i++) {
      const v = faces[i], f = Math.floor(i / 3);
      for (let k = 0; k < 3; k++) {
        data[12 * i + k] = points[3 * v + k] / 32767;
        data[12 * i + 3 + k] = colors[3 * f + k] / 255;
        data[12 * i + 6 + k] = ways[3 * piece[v] + k];
        data[12 * i + 9 + k] = i % 3 === k ? 1 : 0;
      }
    }
    return data;
  }

  async function start(figure) {
    const mesh = JSON.parse(figure.querySelector("script").textContent);
    const canvas = figure.querySelector("canvas"), slider = figure.querySelector("input");
    const gl = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true });
    if (!gl) { figure.append("This browser draws no meshes: it has no WebGL 2."); return; }
    const program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text); gl.compileShader(shader); gl.attachShader(program, shader);
    }
    gl.linkProgram(program); gl.useProgram(program); gl.enable(gl.DEPTH_TEST);
    const data = await corners(mesh);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
    ["place", "tone", "way", "side"].forEach((name, i) => {
      const where = gl.getAttribLocation(program, name);
      gl.enableVertexAttribArray(where);
      gl.vertexAttribPointer(where, 3, gl.FLOAT, false, 48, 12 * i);
    });
    const set = (name) => gl.getUniformLocation(program, name);
    let around = 0.5, lifted = 0.32, zoom = 0.97;  // the whole sphere around the mesh is seen
    function draw() {
      canvas.width = canvas.clientWidth * devicePixelRatio;
      canvas.height = canvas.clientHeight * devicePixelRatio;
      gl.viewport(0, 0, canvas.width, canvas.height);
      gl.clearColor(0.957, 0.953, 0.945, 1); gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      const [c, s, u, v] = [Math.cos(around), Math.sin(around), Math.cos(lifted), Math.sin(lifted)];
      gl.uniformMatrix3fv(set("turn"), false, [c, s * v, -s * u, 0, u, v, s, -c * v, c * u]);
      const apart = slider ? slider.value / 100 : 0;
      gl.uniform1f(set("apart"), apart); gl.uniform1f(set("zoom"), zoom / (1 + 0.6 * apart));
      gl.uniform1f(set("wide"), canvas.width / canvas.height);
      gl.uniform1f(set("wires"), mesh.wires ? 1 : 0);
      gl.drawArrays(gl.TRIANGLES, 0, data.length / 12);
    }
    function move(right, down, nearer = 1) {
      around += right;
      lifted = Math.max(-1.5, Math.min(1.5, lifted + down));
      zoom *= nearer;
      draw();
    }
    canvas.onpointerdown = (event) => canvas.setPointerCapture(event.pointerId);
    canvas.onpointermove = (event) => {
      if (event.buttons) move(event.movementX / 150, event.movementY / 150);
    };
    canvas.onkeydown = (event) => {
      const step = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1],
        ArrowDown: [0, 0.1], "+": [0, 0, 1.1], "-": [0, 0, 1 / 1.1] }[event.key];
      if (!step || event.ctrlKey || event.metaKey) return; // these zoom the whole page
      event.preventDefault();
      move(...step);
    };
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      move(0, 0, Math.exp(-event.deltaY / 800));
    }, { passive: false });
    if (slider) slider.oninput = draw;
    new ResizeObserver(draw).observe(canvas);
  }
  for (const figure of document.querySelectorAll("figure.turnable:not([data-on])")) {
    figure.dataset.on = ""; start(figure);
  }
})();
