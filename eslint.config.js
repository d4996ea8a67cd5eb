// What holds for the pages' scripts and their tests: every value has a type, and a promise that nobody waits for, or whose failure
// nobody sees, is an error.

import eslint from "@eslint/js";
import tseslint from "typescript-eslint";
import promises from "./lint/promises.js";

export default tseslint.config({
  files: ["static/js/**/*.js", "tests/js/**/*.js"],
  extends: [eslint.configs.recommended, tseslint.configs.recommendedTypeChecked],
  languageOptions: { parserOptions: { projectService: true, tsconfigRootDir: import.meta.dirname } },
  plugins: { promises },
  rules: {
    "no-undef": "off", // tsconfig.json knows the names of browser and Node.js
    "@typescript-eslint/no-floating-promises": [
      "error",
      { ignoreVoid: false, allowForKnownSafeCalls: [{ from: "package", package: "node:test", name: ["test"] }] },
    ],
    "@typescript-eslint/no-misused-promises": "error",
    "@typescript-eslint/no-shadow": "error",
    "@typescript-eslint/no-use-before-define": ["error", { functions: false }],
    "@typescript-eslint/no-unused-vars": ["error", { argsIgnorePattern: "^_" }],
    "array-callback-return": "error",
    "consistent-return": "error",
    eqeqeq: "error",
    "no-param-reassign": "error",
    "object-shorthand": "error",
    "prefer-const": "error",
    "prefer-template": "error",
    "promises/handed": "error",
  },
});
