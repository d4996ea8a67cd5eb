// The API's documentation: starts Swagger UI, whose own start script is inline and would be refused by the
// Content-Security-Policy. Not a module, as Swagger UI is none.

const target = document.getElementById("swagger-ui");

const page = /** @type {{ SwaggerUIBundle: (options: object) => void }} */ (/** @type {unknown} */ (window));

page.SwaggerUIBundle({
  domNode: target,
  url: target?.dataset.document,
  deepLinking: true,
  defaultModelsExpandDepth: 0,
  displayRequestDuration: true,
  tryItOutEnabled: true,
  validatorUrl: null,
});
