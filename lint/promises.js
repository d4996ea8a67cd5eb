// What typescript-eslint's rules on promises cannot see, since most scripts are without types yet: promises on their way through
// something of unknown type, where nobody would wait for them or hear that they failed.

import ts from "typescript";

const HANDED = "This may give a promise, and who takes it does not say that it waits for one: write its type, or use start().";
const CALLED = "'{{name}}' gives a promise elsewhere: await it, use start(), or write the type of what it is called on.";
const DEPTH = 3; // of objects within objects

const parts = (type) => (type.isUnionOrIntersection() ? type.types : [type]);
const unknown = (type) => Boolean(type.flags & (ts.TypeFlags.Any | ts.TypeFlags.Unknown));
const isPromise = (type) => parts(type).some((part) => !unknown(part) && part.getProperty("then"));
const givesPromise = (type) => parts(type).some((part) => part.getCallSignatures().some((each) => isPromise(each.getReturnType())));
const isLiteral = (type) => Boolean(type.flags & ts.TypeFlags.Object && type.objectFlags & ts.ObjectFlags.ObjectLiteral);

/** Whether a type is a promise, gives one when it is called, or holds one that does. */
function promises(checker, type, node, depth = DEPTH) {
  if (isPromise(type) || givesPromise(type)) return true;
  if (!depth) return false;
  const inside = parts(type).flatMap((part) => {
    if (checker.isArrayType(part) || checker.isTupleType(part)) return checker.getTypeArguments(part);
    return isLiteral(part) ? part.getProperties().map((each) => checker.getTypeOfSymbolAtLocation(each, node)) : [];
  });
  return inside.some((each) => promises(checker, each, node, depth - 1));
}

/** Whether something of this type may be given a promise: its type says so, or is what it is given. */
function waits(checker, type, node) {
  const open = (each) => Boolean(each.flags & ts.TypeFlags.TypeParameter) || isPromise(each);
  return parts(type).some((part) => open(part)
    || part.getCallSignatures().some((each) => parts(each.getReturnType()).some(open))
    || (!unknown(part) && promises(checker, part, node)));
}

const handed = {
  meta: { type: "problem", schema: [], messages: { handed: HANDED } },
  create(context) {
    const { program, esTreeNodeToTSNodeMap: nodes } = context.sourceCode.parserServices;
    const checker = program.getTypeChecker();
    function check(given, taken) {
      const node = nodes.get(given);
      if (!promises(checker, checker.getTypeAtLocation(node), node)) return;
      const type = taken ? checker.getTypeAtLocation(nodes.get(taken)) : checker.getContextualType(node);
      if (!type || !waits(checker, type, node)) context.report({ node: given, messageId: "handed" });
    }
    return {
      "CallExpression, NewExpression": (call) => call.arguments.forEach((given) => check(given.type === "SpreadElement" ? given.argument : given)),
      AssignmentExpression: ({ left, right }) => check(right, left),
      // What is either unknown or a promise is unknown.
      "LogicalExpression, ConditionalExpression": (whole) => {
        const either = [whole.right, whole.consequent, whole.alternate];
        if (unknown(checker.getTypeAtLocation(nodes.get(whole)))) either.forEach((given) => given && check(given, whole));
      },
    };
  },
};

const known = new WeakMap(); // names by program

/** The names of functions that give promises: of the scripts' own each one, of the browser's those that do wherever they occur. */
function promising(program) {
  if (known.has(program)) return known.get(program);
  const checker = program.getTypeChecker();
  const [own, gives, other] = [new Set(), new Set(), new Set(["catch"])]; // what has a catch() is looked after
  for (const file of program.getSourceFiles()) {
    const look = (node) => {
      const called = node.name ?? node.parent?.name; // `const name = async () => …` has its name outside
      if (ts.isFunctionLike(node) && called) {
        const promise = isPromise(checker.getReturnTypeOfSignature(checker.getSignatureFromDeclaration(node)));
        if (promise) (file.isDeclarationFile ? gives : own).add(called.getText(file));
        else if (file.isDeclarationFile) other.add(called.getText(file));
      }
      ts.forEachChild(node, look);
    };
    look(file);
  }
  // Films have play() as animations have, but only the films' gives a promise.
  const found = new Set([...own, "play", ...[...gives].filter((name) => !other.has(name))]);
  known.set(program, found);
  return found;
}

/** Whether nobody takes what an expression gives: it is a statement, or all that an arrow function does. */
function isDropped(node) {
  const { parent } = node;
  const passes = ["ChainExpression", "LogicalExpression", "ConditionalExpression", "SequenceExpression"].includes(parent.type);
  if (passes) return isDropped(parent);
  return parent.type === "ExpressionStatement" || (parent.type === "ArrowFunctionExpression" && parent.body === node);
}

const called = {
  meta: { type: "problem", schema: [], messages: { called: CALLED } },
  create(context) {
    const { program, esTreeNodeToTSNodeMap: nodes } = context.sourceCode.parserServices;
    const checker = program.getTypeChecker();
    return {
      CallExpression(call) {
        const name = call.callee.name ?? call.callee.property?.name;
        if (!name || !isDropped(call) || !unknown(checker.getTypeAtLocation(nodes.get(call.callee)))) return;
        if (promising(program).has(name)) context.report({ node: call, messageId: "called", data: { name } });
      },
    };
  },
};

export default { rules: { handed, called } };
